# OMPL as one target. OMPL 1.5.2 exports none of its own.
# Sets up the INTERFACE library NAME; for this build and, installed, for programs that use the component ompl.
function(downwash_add_libompl NAME)
  find_package(Eigen3 REQUIRED)
  find_package(ompl REQUIRED)
  # The first of its libraries is OMPL. The others are named by the paths of developer packages that OMPL's own package does not
  # bring, and only OMPL itself uses them.
  list(GET OMPL_LIBRARIES 0 library)
  add_library(${NAME} INTERFACE ${ARGN})
  target_include_directories(${NAME} SYSTEM INTERFACE ${OMPL_INCLUDE_DIRS} ${EIGEN3_INCLUDE_DIRS})
  target_link_libraries(${NAME} INTERFACE ${library})
endfunction()
