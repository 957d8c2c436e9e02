# libsdformat 12 as SDFormat::SDFormat. Its own package brings finders of SQLite and others in place of CMake's.
file(GLOB sdformat_folders /usr/include/sdformat-12* /usr/local/include/sdformat-12*)
find_path(SDFormat_INCLUDE_DIR sdf/sdf.hh HINTS ${sdformat_folders})
find_path(SDFormat_MATH_INCLUDE_DIR ignition/math.hh PATH_SUFFIXES ignition/math6)
find_path(SDFormat_UTILS_INCLUDE_DIR ignition/utils/ImplPtr.hh PATH_SUFFIXES ignition/utils1)
find_library(SDFormat_LIBRARY sdformat12)
find_library(SDFormat_MATH_LIBRARY ignition-math6)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(SDFormat REQUIRED_VARS
  SDFormat_LIBRARY SDFormat_MATH_LIBRARY SDFormat_INCLUDE_DIR SDFormat_MATH_INCLUDE_DIR SDFormat_UTILS_INCLUDE_DIR)
if(SDFormat_FOUND AND NOT TARGET SDFormat::SDFormat)
  add_library(SDFormat::SDFormat UNKNOWN IMPORTED)
  set_target_properties(SDFormat::SDFormat PROPERTIES
    IMPORTED_LOCATION ${SDFormat_LIBRARY}
    INTERFACE_INCLUDE_DIRECTORIES "${SDFormat_INCLUDE_DIR};${SDFormat_MATH_INCLUDE_DIR};${SDFormat_UTILS_INCLUDE_DIR}"
    INTERFACE_LINK_LIBRARIES ${SDFormat_MATH_LIBRARY})
endif()
