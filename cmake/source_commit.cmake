# cmake -DSOURCE=dir -DHEADER=file -P source_commit.cmake
# Writes the commit of a working tree into a header, which is touched only when that changes. "-dirty" says that tracked
# files differ from it, results aside: they come after the program that made them.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE result)
if(NOT result EQUAL 0 OR commit STREQUAL "")
  set(commit unknown)
else()
  execute_process(COMMAND git -C ${SOURCE} --no-optional-locks status --porcelain --untracked-files=no -- . :!bench/results
    OUTPUT_VARIABLE changes ERROR_QUIET)
  if(NOT changes STREQUAL "")
    string(APPEND commit -dirty)
  endif()
endif()
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once\n#define DOWNWASH_SOURCE_COMMIT \"${commit}\"\n")
