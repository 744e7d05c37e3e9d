# The libraries that gnomon stands on, as one list: GNOMON_LIBRARIES.
#
# Read by our own build, and installed beside gnomonConfig.cmake: who links the static library needs them again.
find_package(Threads REQUIRED)
find_package(PkgConfig REQUIRED)
set(GNOMON_MODULES vulkan jansson spng libturbojpeg assimp gmp mpfr)
pkg_check_modules(GNOMON_MODULES REQUIRED IMPORTED_TARGET ${GNOMON_MODULES})

# Not through OpenEXR's own CMake package or pkg-config file: they ask for Imath, Python bindings and the C++ libraries,
# and Debian's libopenexr-dev alone does not satisfy the first. We use the C library and nothing else.
find_library(OPENEXRCORE_LIBRARY OpenEXRCore REQUIRED)
find_path(OPENEXRCORE_INCLUDE_DIR openexr.h PATH_SUFFIXES OpenEXR REQUIRED)
mark_as_advanced(OPENEXRCORE_LIBRARY OPENEXRCORE_INCLUDE_DIR)
if(NOT TARGET gnomon::OpenEXRCore)
  add_library(gnomon::OpenEXRCore UNKNOWN IMPORTED)
  set_target_properties(gnomon::OpenEXRCore PROPERTIES IMPORTED_LOCATION ${OPENEXRCORE_LIBRARY}
                                                       INTERFACE_INCLUDE_DIRECTORIES ${OPENEXRCORE_INCLUDE_DIR})
endif()

set(GNOMON_LIBRARIES PkgConfig::GNOMON_MODULES gnomon::OpenEXRCore Threads::Threads m)
