# Compiles for Windows on Linux, by MinGW-w64's GCC with POSIX threads (Debian: g++-mingw-w64-x86-64-posix). The
# environment variable TWINRAY_WINDOWS_PACKAGES names the folder that tools/windows_packages.sh made.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR AMD64)

set(target x86_64-w64-mingw32)
set(CMAKE_C_COMPILER ${target}-gcc-posix)
set(CMAKE_CXX_COMPILER ${target}-g++-posix)
set(CMAKE_RC_COMPILER ${target}-windres)
set(CMAKE_AR ${target}-ar CACHE FILEPATH "")
set(CMAKE_RANLIB ${target}-ranlib CACHE FILEPATH "")

set(CMAKE_FIND_ROOT_PATH /usr/${target} $ENV{TWINRAY_WINDOWS_PACKAGES} ${CMAKE_PREFIX_PATH})
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER) # the compiler of shaders and Python run here
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)

# Programs of the target run here by Wine, where that is installed, with Wine's own folder for temporary files.
find_program(TWINRAY_WINE NAMES wine wine64 DOC "runs Windows' programs: package wine")
if(TWINRAY_WINE)
    set(CMAKE_CROSSCOMPILING_EMULATOR env -u TMPDIR ${TWINRAY_WINE})
endif()

# No program needs a DLL of the compiler or of zlib. Only the compiler's own DLL carries exceptions from one DLL to
# another.
if(NOT BUILD_SHARED_LIBS)
    set(CMAKE_EXE_LINKER_FLAGS_INIT -static)
endif()
set(ZLIB_USE_STATIC_LIBS ON)
