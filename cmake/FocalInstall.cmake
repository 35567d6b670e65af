# What `cmake --install` lays down: the library, its header, the command, the stock models, and how CMake and pkg-config find them.
include(CMakePackageConfigHelpers)

install(TARGETS focal EXPORT focal-targets
  LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
  RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/focal DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_SOURCE_DIR}/THIRD_PARTY.md DESTINATION ${CMAKE_INSTALL_DOCDIR})

set(package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/focal)
install(EXPORT focal-targets NAMESPACE focal:: DESTINATION ${package_folder})
configure_package_config_file(${CMAKE_CURRENT_LIST_DIR}/focal-config.cmake.in ${PROJECT_BINARY_DIR}/focal-config.cmake
  INSTALL_DESTINATION ${package_folder})
# Before 1.0 each minor version may change the ABI.
write_basic_package_version_file(${PROJECT_BINARY_DIR}/focal-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/focal-config.cmake ${PROJECT_BINARY_DIR}/focal-config-version.cmake
  DESTINATION ${package_folder})

# The prefix is found from where focal.pc lies, so an installed tree may be moved.
file(RELATIVE_PATH FOCAL_PC_TO_PREFIX /prefix/${CMAKE_INSTALL_LIBDIR}/pkgconfig /prefix)
configure_file(${CMAKE_CURRENT_LIST_DIR}/focal.pc.in ${PROJECT_BINARY_DIR}/focal.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/focal.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# The stock models, where samples/stock/make.sh made them.
install(DIRECTORY ${PROJECT_BINARY_DIR}/models/ DESTINATION ${CMAKE_INSTALL_DATADIR}/focal/models OPTIONAL
  FILES_MATCHING PATTERN "*.focal")

# Optional: a build of some targets, such as that of samples/demo.sh, has no module and can be installed too.
if(TARGET focal_cuda)
  install(TARGETS focal_cuda LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL)
endif()
if(TARGET focal_cli)
  set_target_properties(focal_cli PROPERTIES INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}")
  install(TARGETS focal_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
endif()
