# What every module is built with.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_VISIBILITY_INLINES_HIDDEN ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)

include(GNUInstallDirs)
set(CMAKE_INSTALL_RPATH "$ORIGIN/../${CMAKE_INSTALL_LIBDIR}" "$ORIGIN")

include(cmake/dependencies.cmake)

# Headers stand beside their sources and are included as <downwash/module/header.hpp>, here as after installation.
set(DOWNWASH_INCLUDE_DIR ${PROJECT_BINARY_DIR}/include)
file(MAKE_DIRECTORY ${DOWNWASH_INCLUDE_DIR}/downwash)
include(cmake/standard_library.cmake)

add_library(downwash_options INTERFACE)
target_compile_options(downwash_options INTERFACE
  -ffp-contract=off # the same bytes on every processor
  -Wall -Wextra -Wpedantic -Wconversion
  # What shadows a name of another source, or is of a type in an unnamed namespace, does no harm where each is compiled alone.
  "$<IF:$<BOOL:$<TARGET_PROPERTY:UNITY_BUILD>>,$<$<CXX_COMPILER_ID:GNU>:-Wshadow=local;-Wno-subobject-linkage>,-Wshadow>"
  "$<$<CXX_COMPILER_ID:GNU>:SHELL:--param ggc-min-heapsize=400000>" # [KiB] before it collects garbage: a tenth less time
  $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict> # g++ 12 sees overlaps in every "text" + std::string (GCC bug 105651)
  $<$<BOOL:${DOWNWASH_WERROR}>:-Werror>)

# Compiles a target in half the time: what reads, writes and prints spends its time elsewhere. Same results, same bytes.
function(downwash_optimise_little TARGET)
  # g++ 12 takes members of variants for uninitialised at this level
  target_compile_options(${TARGET} PRIVATE "$<$<CONFIG:Release>:-O1;$<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>>")
endfunction()

include(cmake/precompiled.cmake)
include(cmake/unity.cmake)

# downwash_module(NAME SOURCES ... USES modules... PRIVATE libraries... PRIVATE_HEADERS files... [INTERNAL | CONTAINS modules...]
#                 [COLD])
# Adds the library downwash_NAME, alias downwash::NAME. The folder's headers are installed, except those after
# PRIVATE_HEADERS. An INTERNAL module is no library of its own: it becomes part of the one that CONTAINS it. A COLD module
# does no work worth optimising: see downwash_optimise_little().
function(downwash_module NAME)
  cmake_parse_arguments(MODULE "INTERNAL;COLD" "" "SOURCES;USES;PRIVATE;PRIVATE_HEADERS;CONTAINS" ${ARGN})
  if(MODULE_UNPARSED_ARGUMENTS)
    message(FATAL_ERROR "downwash_module(${NAME}): unknown argument ${MODULE_UNPARSED_ARGUMENTS}")
  endif()
  file(CREATE_LINK ${CMAKE_CURRENT_SOURCE_DIR} ${DOWNWASH_INCLUDE_DIR}/downwash/${NAME} SYMBOLIC)
  list(TRANSFORM MODULE_USES PREPEND downwash_)
  set(kind)
  if(MODULE_INTERNAL)
    set(kind OBJECT)
  endif()
  add_library(downwash_${NAME} ${kind} ${MODULE_SOURCES})
  add_library(downwash::${NAME} ALIAS downwash_${NAME})
  target_include_directories(downwash_${NAME} PUBLIC
    $<BUILD_INTERFACE:${DOWNWASH_INCLUDE_DIR}> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(downwash_${NAME} PUBLIC cxx_std_20)
  target_link_libraries(downwash_${NAME} PUBLIC ${MODULE_USES} PRIVATE $<BUILD_INTERFACE:downwash_options> ${MODULE_PRIVATE})
  if(MODULE_COLD)
    downwash_optimise_little(downwash_${NAME})
    downwash_use_precompiled(downwash_${NAME} downwash_precompiled_cold)
  else()
    downwash_use_precompiled(downwash_${NAME} downwash_precompiled)
  endif()
  downwash_unite(downwash_${NAME})
  foreach(part IN LISTS MODULE_CONTAINS)
    target_link_libraries(downwash_${NAME} PRIVATE $<BUILD_INTERFACE:downwash_${part}>)
  endforeach()
  file(GLOB headers CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.hpp)
  foreach(header IN LISTS MODULE_PRIVATE_HEADERS)
    if(NOT EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/${header})
      message(FATAL_ERROR "downwash_module(${NAME}): there is no private header ${header}")
    endif()
    list(REMOVE_ITEM headers ${CMAKE_CURRENT_SOURCE_DIR}/${header})
  endforeach()
  if(MODULE_INTERNAL)
    install(FILES ${headers} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/downwash/${NAME})
    set_target_properties(downwash_${NAME} PROPERTIES PUBLIC_HEADER "${headers}")
    set_property(GLOBAL APPEND PROPERTY DOWNWASH_INTERNAL_MODULES ${NAME})
    return()
  endif()
  set_target_properties(downwash_${NAME} PROPERTIES
    PUBLIC_HEADER "${headers}"
    EXPORT_NAME ${NAME} VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  set_property(GLOBAL APPEND PROPERTY DOWNWASH_MODULES ${NAME})
endfunction()

# Sets OUT to the targets of this project that TARGET links, and to those that these link.
function(downwash_linked_targets OUT TARGET)
  set(found "")
  set(open ${TARGET})
  while(open)
    list(POP_FRONT open target)
    get_target_property(libraries ${target} LINK_LIBRARIES)
    foreach(library IN LISTS libraries)
      string(REGEX REPLACE "^\\$<BUILD_INTERFACE:(.*)>$" "\\1" library "${library}")
      string(REGEX REPLACE "^downwash::" "downwash_" library "${library}")
      if(library MATCHES "^downwash_" AND TARGET ${library} AND NOT library IN_LIST found)
        list(APPEND found ${library})
        list(APPEND open ${library})
      endif()
    endforeach()
  endwhile()
  set(${OUT} ${found} PARENT_SCOPE)
endfunction()
