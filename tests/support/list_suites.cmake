# After a program of GoogleTest is built: writes FILE, by which ctest runs each suite of it in one process. A test of it
# alone is run by the program, with --gtest_filter.
#   cmake -D PROGRAM=FILE [-D EMULATOR=COMMAND] -D LABEL=NAME -D QUICK=REGEX -D FULL=REGEX -D RESULTS=FOLDER -D FILE=FILE
#         -P list_suites.cmake
#     EMULATOR   runs the program, which is one of another system
#     QUICK      suites that get the label LABEL.quick instead
#     FULL       suites that also get the label full
#     RESULTS    where each suite leaves an XML file of what its tests did
execute_process(COMMAND ${EMULATOR} ${PROGRAM} --gtest_list_tests OUTPUT_VARIABLE listing COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\r" "" listing "${listing}")
set(command ${EMULATOR} ${PROGRAM})
list(JOIN command "]=] [=[" command)
if(EMULATOR)
    string(PREPEND RESULTS Z:) # the root as Wine names it: without a drive a path is relative
endif()
string(REGEX MATCHALL "(^|\n)[^ \n]+\\.[ \n]" suites "${listing}")
set(tests "")
foreach(suite ${suites})
    string(REGEX REPLACE "^\n?(.*)\\.[ \n]$" "\\1" suite "${suite}")
    set(label ${LABEL})
    if(QUICK AND suite MATCHES "${QUICK}")
        string(APPEND label .quick)
    endif()
    if(suite MATCHES "${FULL}")
        string(APPEND label "\;full")
    endif()
    string(REPLACE / . result "${suite}")
    string(
        APPEND tests
        "add_test([=[${suite}]=] [=[${command}]=] [=[--gtest_filter=${suite}.*]=])\n"
        "set_tests_properties([=[${suite}]=] PROPERTIES LABELS [=[${label}]=] TIMEOUT 900\n"
        "    ENVIRONMENT [=[GTEST_OUTPUT=xml:${RESULTS}/${result}.xml]=])\n"
    )
endforeach()
file(WRITE ${FILE} "${tests}")
