# cmake -DSOURCE=... -DHEADER=... -P WriteCommit.cmake: OSTEON_COMMIT as it is at this build, with "+" when the tree has changes. The header
# is touched only when that changes, so nothing is compiled in vain.
execute_process(COMMAND git describe --always --exclude=* --abbrev=12 --dirty=+ WORKING_DIRECTORY ${SOURCE} OUTPUT_VARIABLE commit
  OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
file(CONFIGURE OUTPUT ${HEADER} CONTENT "#define OSTEON_COMMIT \"@commit@\"\n" @ONLY)
