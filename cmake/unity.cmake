# Sources of a target compiled several at a time: a build from nothing reads their headers once instead of ten times. After a
# change of one source it compiles those beside it again, so a folder to work in may have it off.

option(DOWNWASH_UNITY "Compile the sources of a module several at a time: faster from nothing, slower after a change" OFF)
set(DOWNWASH_UNITY_BATCH 10 CACHE STRING "How many sources of a module are compiled at a time, at most")
mark_as_advanced(DOWNWASH_UNITY_BATCH)

# Sets OUT to what a source declares at the left margin, as far as it could meet the same in another source: names of types,
# constants and variables, functions with the types of their parameters.
function(downwash_names_in OUT SOURCE)
  file(READ ${SOURCE} text)
  string(REGEX REPLACE "\n *(namespace|using namespace|using [A-Za-z_]+::|#|//|template)[^\n]*" "\n" text "${text}")
  string(REGEX REPLACE "[][]" " " text "${text}")
  string(REPLACE ";" " ;" text "${text}")
  string(REGEX MATCHALL "\n[a-zA-Z][^\n({=;]*[ *&][A-Za-z_0-9]+\\([^\n;{]*" functions "${text}")
  list(TRANSFORM functions REPLACE "^[^(]*[ *&]([A-Za-z_0-9]+\\()" "\\1")
  list(TRANSFORM functions REPLACE " [A-Za-z_0-9]+([,)])" "\\1")
  string(REGEX MATCHALL "\n(struct|class|enum class|using) [A-Za-z_0-9]+" types "${text}")
  string(REGEX MATCHALL "\n(const|constexpr) [^\n(={;]*[ *&][A-Za-z_0-9]+ *[={(]" values "${text}")
  list(TRANSFORM types REPLACE "^.* " "")
  list(TRANSFORM values REPLACE "^.*[ *&]([A-Za-z_0-9]+) *[={(]$" "\\1")
  set(names ${functions} ${types} ${values})
  list(REMOVE_DUPLICATES names)
  set(${OUT} ${names} PARENT_SCOPE)
endfunction()

# Each source goes into the first batch of at most DOWNWASH_UNITY_BATCH in which nothing is called as something in it. Those with
# compile options or definitions of their own are compiled alone, as are those with SKIP_UNITY_BUILD_INCLUSION.
function(downwash_unite TARGET)
  if(NOT DOWNWASH_UNITY)
    return()
  endif()
  set_target_properties(${TARGET} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP
    UNITY_BUILD_CODE_BEFORE_INCLUDE "// NOLINTNEXTLINE(bugprone-suspicious-include)")
  get_target_property(sources ${TARGET} SOURCES)
  foreach(source IN LISTS sources)
    get_filename_component(path ${source} ABSOLUTE)
    downwash_names_in(names ${path})
    foreach(batch RANGE 100)
      set(all ${names_${batch}} ${names})
      list(LENGTH all before)
      list(REMOVE_DUPLICATES all)
      list(LENGTH all after)
      list(LENGTH sources_${batch} size)
      if(size LESS DOWNWASH_UNITY_BATCH AND before EQUAL after)
        set(group ${batch})
        break()
      endif()
    endforeach()
    list(APPEND sources_${group} ${source})
    list(APPEND names_${group} ${names})
    set_source_files_properties(${source} PROPERTIES UNITY_GROUP ${group})
  endforeach()
endfunction()
