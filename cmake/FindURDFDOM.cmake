# liburdfdom as URDFDOM::URDFDOM. The configuration that it installs finds whatever library was looked for first.
find_path(URDFDOM_INCLUDE_DIR urdf_parser/urdf_parser.h)
find_library(URDFDOM_LIBRARY urdfdom_model)
find_library(URDFDOM_CONSOLE_LIBRARY console_bridge)
include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(URDFDOM REQUIRED_VARS URDFDOM_LIBRARY URDFDOM_CONSOLE_LIBRARY URDFDOM_INCLUDE_DIR)
if(URDFDOM_FOUND AND NOT TARGET URDFDOM::URDFDOM)
  add_library(URDFDOM::URDFDOM UNKNOWN IMPORTED)
  set_target_properties(URDFDOM::URDFDOM PROPERTIES
    IMPORTED_LOCATION ${URDFDOM_LIBRARY} INTERFACE_INCLUDE_DIRECTORIES ${URDFDOM_INCLUDE_DIR}
    INTERFACE_LINK_LIBRARIES ${URDFDOM_CONSOLE_LIBRARY})
endif()
