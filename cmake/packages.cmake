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
