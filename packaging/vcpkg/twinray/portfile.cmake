# An overlay port of this checkout: vcpkg install twinray --overlay-ports=packaging/vcpkg
# It gives the libraries. The command also needs GMP's C++ interface, which a build of the checkout finds.
get_filename_component(SOURCE_PATH ${CMAKE_CURRENT_LIST_DIR}/../../.. ABSOLUTE)

vcpkg_cmake_configure(
    SOURCE_PATH ${SOURCE_PATH}
    OPTIONS
        -DTWINRAY_BUILD_CLI=OFF
        -DTWINRAY_BUILD_PATH_TRACER=OFF
        -DTWINRAY_BUILD_SAMPLES=OFF
        -DTWINRAY_BUILD_TESTS=OFF
        -DTWINRAY_INSTALL=ON
        -DTWINRAY_GLSLANG_VALIDATOR=${CURRENT_HOST_INSTALLED_DIR}/tools/glslang/glslangValidator${VCPKG_HOST_EXECUTABLE_SUFFIX}
        -DTWINRAY_SPIRV_OPT=${CURRENT_HOST_INSTALLED_DIR}/tools/spirv-tools/spirv-opt${VCPKG_HOST_EXECUTABLE_SUFFIX}
)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(PACKAGE_NAME twinray CONFIG_PATH lib/cmake/twinray)
vcpkg_fixup_pkgconfig()
file(REMOVE_RECURSE ${CURRENT_PACKAGES_DIR}/debug/include ${CURRENT_PACKAGES_DIR}/debug/share)
vcpkg_install_copyright(FILE_LIST ${SOURCE_PATH}/LICENSE)
