# The files that `cmake --install` installs: the library, its public headers with the GLSL that kernels of a host
# include, and package files for find_package(twinray) and pkg-config.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

set(headers_dir ${CMAKE_INSTALL_INCLUDEDIR})
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/twinray)
set(generated_dir ${PROJECT_BINARY_DIR}/package)

install(
    TARGETS twinray ${TWINRAY_LIBRARIES}
    EXPORT twinrayTargets
    INCLUDES DESTINATION ${headers_dir} ${CMAKE_INSTALL_INCLUDEDIR}
)
install(EXPORT twinrayTargets NAMESPACE twinray:: DESTINATION ${package_dir})
if(TARGET twinray_cli)
    set_target_properties(twinray_cli PROPERTIES INSTALL_RPATH $ORIGIN/../${CMAKE_INSTALL_LIBDIR})
    install(TARGETS twinray_cli)
    if(TARGET twinray_mpi)
        install(TARGETS twinray_mpi LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/twinray)
    endif()
    if(NOT CMAKE_CROSSCOMPILING)
        set(texts ${PROJECT_BINARY_DIR}/cli/texts)
        install(DIRECTORY ${texts}/man1 DESTINATION ${CMAKE_INSTALL_MANDIR})
        install(FILES ${texts}/twinray DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
        install(FILES ${texts}/_twinray DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
        install(FILES ${texts}/twinray.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)
    endif()
endif()

# DLLs of the compiler, which our DLLs need beside them.
if(MINGW AND BUILD_SHARED_LIBS)
    foreach(name libgcc_s_seh-1.dll libstdc++-6.dll libwinpthread-1.dll)
        execute_process(
            COMMAND ${CMAKE_CXX_COMPILER} -print-file-name=${name}
            OUTPUT_VARIABLE file
            OUTPUT_STRIP_TRAILING_WHITESPACE
            COMMAND_ERROR_IS_FATAL ANY
        )
        install(FILES ${file} DESTINATION ${CMAKE_INSTALL_BINDIR})
    endforeach()
endif()

install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} RENAME copyright)
# The programs and DLLs contain everything else that tools/windows_packages.sh has.
if(MINGW)
    install(DIRECTORY $ENV{TWINRAY_WINDOWS_PACKAGES}/licenses DESTINATION ${CMAKE_INSTALL_DOCDIR})
endif()

# Installs only the public headers, and the files that their GLSL needs.
install(DIRECTORY include/twinray DESTINATION ${headers_dir})
set(glsl_dir ${headers_dir}/twinray/glsl)
install(DIRECTORY shaders/shared DESTINATION ${glsl_dir}/shaders)
install(FILES shaders/engine/trace.comp DESTINATION ${glsl_dir}/shaders/engine)
install(DIRECTORY shaders/hwtlas DESTINATION ${glsl_dir}/shaders FILES_MATCHING PATTERN "*.glsl")

# A host of a static library links the library's dependencies itself.
set(find_link_only "")
set(requires_link_only "")
set(libs_link_only "")
if(NOT BUILD_SHARED_LIBS)
    set(find_link_only "find_dependency(ZLIB)")
    set(requires_link_only "zlib")
    if(WIN32)
        set(libs_link_only " -lws2_32")
    endif()
    if(TWINRAY_SCENE)
        string(APPEND find_link_only "\nfind_dependency(OpenEXR CONFIG)")
        string(APPEND requires_link_only " OpenEXR")
        foreach(format ${TWINRAY_FORMATS})
            if(NOT format STREQUAL DRACO) # merged into ours
                string(APPEND libs_link_only " ${${format}_LIBRARY}")
            endif()
        endforeach()
    endif()
endif()
set(only_of_mingw "")
if(MINGW)
    set(only_of_mingw
        "if(NOT MINGW)
    set(twinray_FOUND FALSE)
    set(twinray_NOT_FOUND_MESSAGE
        \"these libraries were built by MinGW-w64: a compiler of another C++ ABI, such as MSVC, cannot link them\")
    return()
endif()"
    )
endif()
list(TRANSFORM TWINRAY_LIBRARIES PREPEND "-l" OUTPUT_VARIABLE link_flags)
list(REVERSE link_flags)
list(JOIN link_flags " " link_flags)
configure_package_config_file(
    cmake/twinrayConfig.cmake.in
    ${generated_dir}/twinrayConfig.cmake
    INSTALL_DESTINATION ${package_dir}
    PATH_VARS headers_dir
)
write_basic_package_version_file(${generated_dir}/twinrayConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(
    FILES ${generated_dir}/twinrayConfig.cmake ${generated_dir}/twinrayConfigVersion.cmake
    DESTINATION ${package_dir}
)
install(FILES cmake/TwinrayShaders.cmake cmake/TwinraySpirvHeader.cmake DESTINATION ${package_dir})

# Relative to the file itself, so that an installed tree can be moved.
file(RELATIVE_PATH prefix_from_pc ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
string(REGEX REPLACE "/$" "" prefix_from_pc ${prefix_from_pc})
configure_file(cmake/twinray.pc.in ${generated_dir}/twinray.pc @ONLY)
install(FILES ${generated_dir}/twinray.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

if(NOT PROJECT_IS_TOP_LEVEL)
    return()
endif()
# `cpack` packs the tree that `cmake --install` makes: as an archive, and on Linux as a Debian package.
set(CPACK_GENERATOR TGZ DEB)
if(WIN32)
    set(CPACK_GENERATOR ZIP)
    if(BUILD_SHARED_LIBS)
        set(CPACK_PACKAGE_FILE_NAME ${PROJECT_NAME}-${PROJECT_VERSION}-win64-dll)
    endif()
endif()
set(CPACK_PACKAGE_VENDOR twinray)
# To publish the packages, pass -DCPACK_PACKAGE_CONTACT="NAME <ADDRESS>", the Debian package's maintainer.
if(NOT CPACK_PACKAGE_CONTACT)
    set(CPACK_PACKAGE_CONTACT "twinray developers")
endif()
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_STRIP_FILES ON)
# The Python package goes into a wheel.
set(CPACK_INSTALL_CMAKE_PROJECTS "${PROJECT_BINARY_DIR};${PROJECT_NAME};Unspecified;/")

set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
# dpkg-shlibdeps (Debian: dpkg-dev and file) finds what the command links. Without the window it loads Vulkan only when
# it runs.
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# Recommended: a driver, and what programs that link the static libraries need to build.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "libvulkan1, mesa-vulkan-drivers, libvulkan-dev, libopenexr-dev, zlib1g-dev")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "glslang-tools, spirv-tools")
include(CPack)
