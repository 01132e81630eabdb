# Every library that twinray takes from the system. tools/setup.sh installs them.
find_package(Threads REQUIRED)
find_package(Vulkan REQUIRED)
find_package(VulkanMemoryAllocator CONFIG REQUIRED)
find_package(glm CONFIG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(Eigen3 CONFIG REQUIRED)
find_package(nlohmann_json CONFIG REQUIRED)
find_package(OpenEXR CONFIG REQUIRED)
find_package(assimp CONFIG REQUIRED)

find_program(SPIRV_VAL spirv-val REQUIRED)

find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
find_path(STB_INCLUDE_DIR stb_image.h PATH_SUFFIXES stb REQUIRED)

if(TWINRAY_BUILD_APPS)
    find_package(MPI QUIET COMPONENTS C)  # optional, for the path tracer: Debian's libopenmpi-dev and openmpi-bin
    find_package(CLI11 CONFIG REQUIRED)
    find_path(GMPXX_INCLUDE_DIR gmpxx.h REQUIRED)  # Debian: libgmp-dev
    find_library(GMPXX_LIBRARY gmpxx REQUIRED)
    find_library(GMP_LIBRARY gmp REQUIRED)
endif()
if(TWINRAY_BUILD_TESTS)
    find_package(GTest REQUIRED)
    find_package(Python3 COMPONENTS Interpreter REQUIRED)
endif()
