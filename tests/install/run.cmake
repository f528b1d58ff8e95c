# cmake -DBUILD=<build folder> -DSOURCE=<repository> -DWORK=<folder> -P run.cmake
# As a user: installs the library, builds the example against the installed package alone and runs it.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/installed)
run(${CMAKE_COMMAND} -S ${SOURCE}/examples/rig_mesh -B ${WORK}/build -G Ninja -DCMAKE_PREFIX_PATH=${WORK}/installed)
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/installed/bin/osteon --version)
execute_process(COMMAND ${WORK}/build/rig_mesh RESULT_VARIABLE code ERROR_VARIABLE message)
if(NOT code EQUAL 2 OR NOT message MATCHES "usage: rig_mesh")
  message(FATAL_ERROR "rig_mesh without arguments: code ${code}, ${message}")
endif()
