# Copies FILES from SOURCE to OUTPUT and applies PATCHES to the copies, one after the other. Fails
# with a sentence if a patch does not apply.
set(work ${OUTPUT}.new)
file(REMOVE_RECURSE ${work} ${OUTPUT})
foreach(file ${FILES})
  cmake_path(GET file PARENT_PATH folder)
  file(MAKE_DIRECTORY ${work}/${folder})
  file(COPY_FILE ${SOURCE}/${file} ${work}/${file})
endforeach()
foreach(patch ${PATCHES})
  execute_process(
    COMMAND ${PATCH} --strip=1 --fuzz=0 --forward --batch --directory=${work} --input=${patch}
    RESULT_VARIABLE failed OUTPUT_VARIABLE report ERROR_VARIABLE report)
  if(failed)
    message(FATAL_ERROR
      "${patch} does not apply any more: the code that it changes has changed. "
      "Make its hunks fit again, or seed the same bug where the code is now.\n${report}")
  endif()
endforeach()
file(RENAME ${work} ${OUTPUT})
