# Sources of a target compiled several at a time: a build from nothing reads their headers once instead of ten times. After a
# change of one source it compiles those beside it again, so a folder to work in may have it off. Names in unnamed namespaces
# of a folder differ, but for those of the plane and their counterparts in space.

option(DOWNWASH_UNITY "Compile the sources of a module several at a time: faster from nothing, slower after a change" OFF)

# Sources with compile options or definitions of their own are compiled alone, as are those with SKIP_UNITY_BUILD_INCLUSION.
function(downwash_unite TARGET)
  if(NOT DOWNWASH_UNITY)
    return()
  endif()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP
    UNITY_BUILD_CODE_BEFORE_INCLUDE "// NOLINTNEXTLINE(bugprone-suspicious-include)")
  get_target_property(sources ${TARGET} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(group "${source}" DIRECTORY)
    string(MAKE_C_IDENTIFIER "of_${group}" group)
    if(source MATCHES "(space|volume|brick)_[a-z_]*\\.cpp$")
      string(APPEND group _space)
    endif()
    math(EXPR count_${group} "0${count_${group}} + 1")
    math(EXPR batch "(${count_${group}} - 1) / 10")
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group}_${batch})
  endforeach()
endfunction()
