# What `cmake --install` puts where: program, library, header, pkg-config file, CMake package, man page, documents.
include(CMakePackageConfigHelpers)
set(GNOMON_CMAKE_DIR ${CMAKE_INSTALL_LIBDIR}/cmake/gnomon)

install(TARGETS gnomon_program)
install(TARGETS gnomon EXPORT gnomonTargets)
install(FILES include/gnomon.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(FILES README.md LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)
install(FILES man/gnomon.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 OPTIONAL)

# -------------------------------------------------------------------------------------------------------- the pkg-config file
# It finds its prefix from where it lies, so that `cmake --install --prefix` may choose it. Who links the static library must link
# the others too; the shared library has them in itself, and they are private.
file(RELATIVE_PATH GNOMON_PC_PREFIX /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
list(JOIN GNOMON_MODULES " " GNOMON_PC_REQUIRES)
get_filename_component(openexrcore ${OPENEXRCORE_LIBRARY} NAME_WE)
string(REGEX REPLACE "^lib" "-l" openexrcore ${openexrcore})
if(BUILD_SHARED_LIBS)
  set(GNOMON_PC_PRIVATE .private)
  set(GNOMON_PC_LIBS_PRIVATE "${openexrcore} -pthread -lm")
else()
  set(GNOMON_PC_LIBS "${openexrcore} -pthread -lm")
endif()
configure_file(cmake/gnomon.pc.in gnomon.pc @ONLY)
install(FILES ${CMAKE_BINARY_DIR}/gnomon.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# --------------------------------------------------------------------------------------------------------- the CMake package
configure_package_config_file(cmake/gnomonConfig.cmake.in gnomonConfig.cmake INSTALL_DESTINATION ${GNOMON_CMAKE_DIR})
write_basic_package_version_file(gnomonConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(EXPORT gnomonTargets NAMESPACE gnomon:: DESTINATION ${GNOMON_CMAKE_DIR})
install(FILES ${CMAKE_BINARY_DIR}/gnomonConfig.cmake ${CMAKE_BINARY_DIR}/gnomonConfigVersion.cmake cmake/dependencies.cmake
        DESTINATION ${GNOMON_CMAKE_DIR})
