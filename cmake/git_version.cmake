# Writes OUTPUT, a header with the version and commit of SOURCE:
#   cmake -DSOURCE= -DVERSION= -DOUTPUT= -P git_version.cmake
# Rewrites it only when it changes, so that nothing is compiled without need.
execute_process(
    COMMAND git -C ${SOURCE} describe --always --dirty --abbrev=12 --match=NoTag
    OUTPUT_VARIABLE commit
    OUTPUT_STRIP_TRAILING_WHITESPACE
    ERROR_QUIET
)
if(commit)
    string(PREPEND commit " ")
endif()
file(
    CONFIGURE
    OUTPUT ${OUTPUT}
    @ONLY
    CONTENT
        [[
#pragma once

inline constexpr const char* twinray_version = "@VERSION@@commit@";
]]
)
