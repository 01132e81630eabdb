# twinray::twinray: the parts as one object file, in which only namespace twinray is global. A host may then bring its
# own Vulkan Memory Allocator, stb or tinygltf, of whatever version; and an inline function of our headers that the
# host compiles with its own options (-ffast-math) never replaces the one that the library was tested with.
set(parts twinray_engine twinray_swtlas twinray_hwtlas)
set_target_properties(${parts} PROPERTIES POSITION_INDEPENDENT_CODE ON INTERPROCEDURAL_OPTIMIZATION OFF)
foreach(part ${parts})
    # Without the first, position-independent code does not inline what another library could replace. The sections
    # let a host that links with --gc-sections leave out what it does not use, as from an archive of many objects.
    # Without the last, variables of inline functions stay global whatever objcopy is told.
    target_compile_options(${part} PRIVATE
        "$<$<COMPILE_LANGUAGE:CXX>:-fno-semantic-interposition;-ffunction-sections;-fdata-sections>"
        $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-gnu-unique>)
    list(APPEND objects $<TARGET_OBJECTS:${part}>)
endforeach()

set(merge ${PROJECT_SOURCE_DIR}/cmake/merge_objects.sh)
set(library ${PROJECT_BINARY_DIR}/twinray.o)
add_custom_command(
    OUTPUT ${library}
    COMMAND ${merge} ${CMAKE_LINKER} ${CMAKE_NM} ${CMAKE_OBJCOPY} ${library} ${objects}
    DEPENDS ${merge} ${objects}
    COMMENT "Merging twinray.o"
    COMMAND_EXPAND_LISTS VERBATIM)

add_library(twinray ${library})
add_library(twinray::twinray ALIAS twinray)
set_target_properties(twinray PROPERTIES
    LINKER_LANGUAGE CXX
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
target_compile_features(twinray PUBLIC cxx_std_20)
target_include_directories(twinray PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>)
target_link_libraries(twinray
    PUBLIC Vulkan::Headers glm::glm Threads::Threads
    PRIVATE OpenEXR::OpenEXR assimp::assimp ZLIB::ZLIB ${CMAKE_DL_LIBS})
