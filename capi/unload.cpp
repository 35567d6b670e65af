// What the C++ runtime inside the library keeps for good, given back when the library is unloaded: its reserve for
// exceptions when there is no memory, 73 KB, which a host that loads and unloads the library would lose each time.
#if defined(FOCAL_STATIC_RUNTIME)

namespace __gnu_cxx {
void __freeres();  // of libstdc++, for tools that look for leaks
}

namespace {

[[gnu::destructor]] void give_reserve_back() { __gnu_cxx::__freeres(); }

}  // namespace

#endif
