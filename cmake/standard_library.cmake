# Writes <downwash/standard_library.hpp>: with which layouts of the standard library's containers the modules are built.

include(CheckCXXSourceCompiles)

# Sets RESULT to 1 if a preprocessor condition holds where the modules are compiled, or else to 0.
function(downwash_check_condition RESULT CONDITION)
  string(TOUPPER "${CMAKE_BUILD_TYPE}" config)
  set(CMAKE_REQUIRED_FLAGS "${CMAKE_CXX_FLAGS_${config}}")
  set(CMAKE_REQUIRED_QUIET ON)
  unset(${RESULT} CACHE) # flags may have changed
  check_cxx_source_compiles("#include <version>
#if !(${CONDITION})
#error
#endif
int main() {}" ${RESULT})
  if(${RESULT})
    set(${RESULT} 1 PARENT_SCOPE)
  else()
    set(${RESULT} 0 PARENT_SCOPE)
  endif()
  unset(${RESULT} CACHE)
endfunction()

downwash_check_condition(DOWNWASH_USES_LIBSTDCXX "defined(__GLIBCXX__)")
downwash_check_condition(DOWNWASH_GLIBCXX_DEBUG "defined(_GLIBCXX_DEBUG)")
downwash_check_condition(DOWNWASH_CXX11_ABI "_GLIBCXX_USE_CXX11_ABI")
configure_file(cmake/standard_library.hpp.in ${DOWNWASH_INCLUDE_DIR}/downwash/standard_library.hpp @ONLY)
