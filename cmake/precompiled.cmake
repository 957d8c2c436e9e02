# Headers that most sources include, compiled once for all modules with the same options: a fresh build reads them 300 times
# otherwise. A compiler cache does better without. g++ 12 forgets that what it inlines comes from a header of the system, and
# warns of overflows that cannot happen: such warnings are off where headers are precompiled, so modules whose warnings are
# errors read their headers themselves. Tests do not.

if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(precompiled OFF)
else()
  set(precompiled ON)
endif()
option(DOWNWASH_PRECOMPILED "Compile headers of libraries once for all modules" ${precompiled})

# downwash_precompile(NAME HEADERS ... LIBRARIES ... [COLD] [TESTS]): the target NAME precompiles these headers and those of the standard
# library, for targets to use; see downwash_use_precompiled().
function(downwash_precompile NAME)
  cmake_parse_arguments(HEADERS "COLD;TESTS" "" "HEADERS;LIBRARIES" ${ARGN})
  if(NOT DOWNWASH_PRECOMPILED OR (DOWNWASH_WERROR AND NOT HEADERS_TESTS))
    return()
  endif()
  file(GENERATE OUTPUT ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp CONTENT "") # a target needs a source
  add_library(${NAME} OBJECT ${CMAKE_CURRENT_BINARY_DIR}/${NAME}.cpp)
  target_compile_features(${NAME} PRIVATE cxx_std_20)
  target_link_libraries(${NAME} PRIVATE downwash_options ${HEADERS_LIBRARIES})
  if(HEADERS_COLD)
    downwash_optimise_little(${NAME})
  endif()
  target_precompile_headers(${NAME} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map>
    <memory> <optional> <span> <string> <string_view> <utility> <variant> <vector> ${HEADERS_HEADERS})
endfunction()

# Sources with options of their own have to read headers themselves: SKIP_PRECOMPILE_HEADERS.
function(downwash_use_precompiled TARGET NAME)
  if(TARGET ${NAME})
    target_precompile_headers(${TARGET} REUSE_FROM ${NAME})
    target_compile_options(${TARGET} PRIVATE
      $<$<CXX_COMPILER_ID:GNU>:-Wno-stringop-overflow;-Wno-stringop-overread;-Wno-array-bounds;-Wno-maybe-uninitialized>)
  endif()
endfunction()

downwash_precompile(downwash_precompiled)
downwash_precompile(downwash_precompiled_cold COLD HEADERS <nlohmann/json.hpp>)
