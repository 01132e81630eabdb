# The compile options of twinray's own code, not of a host's. GPU kernels have serial twins in C++ that must round
# alike, so contraction is off everywhere.
add_library(twinray_options INTERFACE)
target_compile_features(twinray_options INTERFACE cxx_std_20)
# twinray's code calls no global vk* function; in the headers this would also decide for the host.
target_compile_definitions(twinray_options INTERFACE VK_NO_PROTOTYPES=)
target_include_directories(twinray_options INTERFACE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/include)
target_include_directories(twinray_options SYSTEM INTERFACE ${VOLK_INCLUDE_DIR})
if(MSVC) # not tested
    target_compile_options(
        twinray_options
        INTERFACE /W4 /permissive- /utf-8 /bigobj /fp:precise
    )
else()
    target_compile_options(
        twinray_options
        INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wconversion -Wshadow -ffp-contract=off>
    )
endif()
# Files that are compiled together have more sections than an object of Windows holds by default. For Windows, GCC also
# trusts the registers that an inline function leaves alone, but a linker may take another file's copy of it, compiled
# with other options.
if(MINGW)
    target_compile_options(twinray_options INTERFACE -Wa,-mbig-obj $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-ipa-ra>)
endif()
# Clang's warnings beyond those of GCC.
target_compile_options(
    twinray_options
    INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,Clang>:-Wno-sign-conversion -Wno-missing-braces>
)
# Unity builds compile files together: a local name of one file shadows what another declares, and GCC takes what a
# source file declares for a header's. The presets that compile each file alone warn of shadows.
if(CMAKE_UNITY_BUILD)
    target_compile_options(twinray_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Wno-shadow>)
    target_compile_options(twinray_options INTERFACE $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-subobject-linkage>)
endif()
if(TWINRAY_WERROR)
    target_compile_options(twinray_options INTERFACE $<$<COMPILE_LANGUAGE:CXX>:-Werror>)
endif()
if(TWINRAY_SANITIZE)
    target_compile_options(twinray_options INTERFACE -fsanitize=address,undefined -fno-sanitize-recover=undefined)
    target_link_options(twinray_options INTERFACE -fsanitize=address,undefined)
endif()
# Sanitizers and the counters that a fuzzer and llvm-cov read; tests/fuzz links what starts it.
if(TWINRAY_FUZZ)
    if(NOT CMAKE_CXX_COMPILER_ID STREQUAL Clang)
        message(
            FATAL_ERROR
            "twinray: TWINRAY_FUZZ=ON needs clang, not ${CMAKE_CXX_COMPILER_ID}; tools/fuzz.sh configures it"
        )
    endif()
    set(fuzz_options -fsanitize=address,undefined,float-cast-overflow,fuzzer-no-link)
    list(APPEND fuzz_options -fno-sanitize-recover=all -fprofile-instr-generate -fcoverage-mapping)
    target_compile_options(twinray_options INTERFACE ${fuzz_options})
    target_link_options(twinray_options INTERFACE ${fuzz_options})
endif()
