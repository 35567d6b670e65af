"""_abi.py is what the header gives, and what the header gives is what a C compiler sees.

Environment: FOCAL_SOURCE the project's folder, FOCAL_CC a C compiler.
"""
import ctypes
import os
import pathlib
import subprocess
import sys
import unittest

from focal import _abi
from support import Case

SOURCE = pathlib.Path(os.environ.get("FOCAL_SOURCE") or pathlib.Path(__file__).resolve().parents[2])
BINDING = SOURCE / "bindings" / "python"
HEADER = SOURCE / "include" / "focal" / "focal.h"
sys.path.insert(0, str(BINDING))
import generate_abi  # noqa: E402

SMALL = """
/* A comment; with { braces } and "quotes". */
#ifndef A_H
#define A_H
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
#define FOCAL_VERSION_MAJOR 3
#define FOCAL_VERSION_MINOR 2
#define FOCAL_VERSION_PATCH 1
#define FOCAL_MOST UINT64_C(0x10)
typedef struct focal_thing focal_thing; // opaque
typedef int32_t focal_colour;
enum { FOCAL_COLOUR_RED, FOCAL_COLOUR_DARK_BLUE = 5, FOCAL_COLOUR_GREY };
typedef void (*focal_fn)(void* data, const char* text);
typedef struct focal_pair {
  uint32_t struct_size; /* a; b */
  float a[3], b[2][4];
  const char *first, *second;
  focal_colour colour;
  focal_fn call;
  const focal_thing* thing;
} focal_pair;
FOCAL_API focal_colour focal_mix(const focal_pair* pair, const float weights[3],
                                 focal_thing** out_thing);
FOCAL_API void focal_nothing(void);
#ifdef __cplusplus
}
#endif
#endif
"""


class Generator(Case):
    def test_the_file_is_not_stale(self):
        text = generate_abi.generate(HEADER.read_text(encoding="utf-8"))
        self.assertEqual((BINDING / "focal" / "_abi.py").read_text(encoding="utf-8"), text,
                         "run bindings/python/generate_abi.py")

    def test_staleness_is_seen(self):
        header = pathlib.Path(self.folder()) / "focal.h"
        text = HEADER.read_text(encoding="utf-8")
        for change, code in ((lambda: text, 0), (lambda: text.replace("double pose_time;", "float pose_time;"), 1),
                             (lambda: text.replace("/* Each makes", "/* Each one makes"), 0)):
            header.write_text(change(), encoding="utf-8")
            done = subprocess.run([sys.executable, BINDING / "generate_abi.py", "--check", header], capture_output=True,
                                  text=True, check=False)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertEqual("run bindings/python/generate_abi.py" in done.stderr, code == 1)

    def test_forms_of_declarations(self):
        made = {}
        exec(generate_abi.generate(SMALL), made)
        pair, kinds = made["focal_pair"], dict(made["focal_pair"]._fields_)
        self.assertEqual(list(kinds), ["struct_size", "a", "b", "first", "second", "colour", "call", "thing"])
        self.assertEqual((ctypes.sizeof(kinds["a"]), ctypes.sizeof(kinds["b"])), (12, 32))
        self.assertEqual(len(pair().b), 2)
        self.assertEqual((kinds["first"], kinds["second"], kinds["colour"]),
                         (ctypes.c_char_p, ctypes.c_char_p, ctypes.c_int32))
        self.assertEqual([(one.name, one.value) for one in made["Colour"]], [("RED", 0), ("DARK_BLUE", 5), ("GREY", 6)])
        self.assertEqual(made["FOCAL_MOST"], 16)
        self.assertEqual(made["FUNCTIONS"]["focal_nothing"], (None, []))
        self.assertEqual(made["FUNCTIONS"]["focal_mix"][1][1], ctypes.POINTER(ctypes.c_float))

    def test_what_it_does_not_know_stops_it(self):
        for bad in ("typedef union focal_u { int a; } focal_u;", "FOCAL_API long focal_f(void);", "int x;",
                    "FOCAL_API focal_unknown* focal_f(void);", "enum { FOCAL_LOOSE = 1 };",
                    "typedef struct focal_s { int32_t a : 3; } focal_s;", "FOCAL_API void focal_f(void)"):
            with self.assertRaises(generate_abi.HeaderError, msg=bad):
                generate_abi.generate(SMALL.replace("#ifdef __cplusplus\n}", bad + "\n#ifdef __cplusplus\n}"))
        with self.assertRaisesRegex(generate_abi.HeaderError, "FOCAL_VERSION_PATCH"):
            generate_abi.generate(SMALL.replace("#define FOCAL_VERSION_PATCH 1", ""))


class Layout(Case):
    def structs(self):
        return {name: kind for name, kind in vars(_abi).items()
                if isinstance(kind, type) and issubclass(kind, ctypes.Structure) and hasattr(kind, "_fields_")
                and kind is not ctypes.Structure}

    def test_sizes_offsets_and_numbers_are_those_of_the_compiler(self):
        compiler = os.environ.get("FOCAL_CC")
        if not compiler:
            self.skipTest("FOCAL_CC names no C compiler")
        expected, lines = [], []

        def ask(expression, value):
            lines.append(f'  printf("%lld\\n", (long long)({expression}));')
            expected.append((expression, value))

        for name, kind in self.structs().items():
            ask(f"sizeof({name})", ctypes.sizeof(kind))
            for field, _ in kind._fields_:
                ask(f"offsetof({name}, {field})", getattr(kind, field).offset)
                ask(f"sizeof((({name}*)0)->{field})", getattr(kind, field).size)
        for name, value in vars(_abi).items():
            if name.startswith("FOCAL_"):
                ask(name, value)
        for typedef, values in generate_abi.parse(HEADER.read_text(encoding="utf-8")).enums.items():
            for (name, _), member in zip(values, getattr(_abi, generate_abi.class_name(typedef))):
                ask(name, int(member))
        self.assertGreater(len(expected), 200)
        self.assertEqual(self.compiled(compiler, lines), expected_text(expected))

    def compiled(self, compiler, lines):
        folder = pathlib.Path(self.folder())
        program = ["#include <focal/focal.h>", "#include <stddef.h>", "#include <stdio.h>", "int main(void) {", *lines,
                   "  return 0;", "}"]
        (folder / "layout.c").write_text("\n".join(program) + "\n", encoding="utf-8")
        subprocess.run([compiler, "-I", SOURCE / "include", folder / "layout.c", "-o", folder / "layout"], check=True)
        return subprocess.run([folder / "layout"], capture_output=True, text=True, check=True).stdout

    def test_every_function_of_the_header_is_declared(self):
        header = generate_abi.without_comments(HEADER.read_text(encoding="utf-8"))
        self.assertEqual(header.count("FOCAL_API ") - header.count("#define FOCAL_API "), len(_abi.FUNCTIONS))


def expected_text(expected):
    return "".join(f"{value}\n" for _, value in expected)


if __name__ == "__main__":
    unittest.main()
