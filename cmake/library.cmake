# Makes twinray::core, ::scene, ::analysis and ::validation, and twinray::twinray, which is all of them. Each is one
# object file made of its parts, in which only namespace twinray is global. So a host may bring any version of Vulkan
# Memory Allocator, stb or tinygltf, and an inline function of twinray's headers that the host compiles with its own
# options (-ffast-math) never replaces the one that the library was tested with.
set(TWINRAY_LIBRARIES "")
set(TWINRAY_PARTS "")

# twinray_add_library(<name> PARTS <part>... SEES <name>... USES <library of others>... MERGES <archive of others>...)
function(twinray_add_library name)
    cmake_parse_arguments(arg "" "" "PARTS;SEES;USES;MERGES" ${ARGN})
    list(TRANSFORM arg_PARTS REPLACE ".+" "twinray_\\0_part")
    list(TRANSFORM arg_SEES REPLACE ".+" "twinray_\\0")
    set_target_properties(${arg_PARTS} PROPERTIES POSITION_INDEPENDENT_CODE ON INTERPROCEDURAL_OPTIMIZATION OFF)
    set(objects "")
    foreach(part ${arg_PARTS})
        # Without the first, position-independent code does not inline what another library could replace. The sections
        # let a host that links with --gc-sections leave out what it does not use, as from an archive of many objects.
        # Without the last, variables of inline functions stay global whatever objcopy is told.
        target_compile_options(
            ${part}
            PRIVATE
                "$<$<COMPILE_LANG_AND_ID:CXX,GNU,Clang>:-fno-semantic-interposition;-ffunction-sections;-fdata-sections>"
                $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-gnu-unique>
        )
        list(APPEND objects $<TARGET_OBJECTS:${part}>)
    endforeach()

    # A merged object would count what clang's sanitizers count of each part several times. Objects for Windows could
    # not be linked: their inline functions would become local in groups that a linker drops.
    if(TWINRAY_FUZZ OR WIN32)
        add_library(twinray_${name} ${objects})
        target_link_libraries(twinray_${name} PRIVATE ${arg_MERGES})
        if(WIN32)
            add_custom_command(
                TARGET twinray_${name}
                PRE_LINK
                COMMAND ${PROJECT_SOURCE_DIR}/cmake/rename_symbols_of_others.sh ${CMAKE_NM} ${CMAKE_OBJCOPY} ${objects}
                COMMAND_EXPAND_LISTS
                VERBATIM
            )
        endif()
        if(WIN32 AND name STREQUAL core)
            # The variables of our copy of volk have the names of the loader's functions, which a host may link.
            add_custom_command(
                TARGET twinray_core
                PRE_LINK
                COMMAND
                    ${CMAKE_OBJCOPY} --preserve-dates --wildcard --localize-symbol=vk* --localize-symbol=volk*
                    $<FILTER:$<TARGET_OBJECTS:twinray_core_part>,INCLUDE,core/vulkan>
                VERBATIM
            )
        endif()
    else()
        set(merge ${PROJECT_SOURCE_DIR}/cmake/merge_objects.sh)
        set(library ${PROJECT_BINARY_DIR}/twinray_${name}.o)
        add_custom_command(
            OUTPUT ${library}
            COMMAND ${merge} ${CMAKE_LINKER} ${CMAKE_NM} ${CMAKE_OBJCOPY} ${library} ${objects} ${arg_MERGES}
            DEPENDS ${merge} ${objects}
            COMMENT "Merging twinray_${name}.o"
            COMMAND_EXPAND_LISTS
            VERBATIM
        )
        add_library(twinray_${name} ${library})
    endif()
    add_library(twinray::${name} ALIAS twinray_${name})
    set_target_properties(
        twinray_${name}
        PROPERTIES
            EXPORT_NAME ${name}
            LINKER_LANGUAGE CXX
            VERSION ${PROJECT_VERSION}
            SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
    )
    target_compile_features(twinray_${name} PUBLIC cxx_std_20)
    if(MINGW) # a host's copies of our inline functions are others than ours: cmake/warnings.cmake
        target_compile_options(twinray_${name} PUBLIC $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fno-ipa-ra>)
    endif()
    target_include_directories(
        twinray_${name}
        PUBLIC $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}> $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/include>
    )
    target_link_libraries(twinray_${name} PUBLIC ${arg_SEES} Vulkan::Headers Threads::Threads PRIVATE ${arg_USES})
    set(TWINRAY_LIBRARIES ${TWINRAY_LIBRARIES} twinray_${name} PARENT_SCOPE)
    set(TWINRAY_PARTS ${TWINRAY_PARTS} ${arg_PARTS} PARENT_SCOPE)
endfunction()

twinray_add_library(core PARTS core swtlas hwtlas USES ZLIB::ZLIB ${CMAKE_DL_LIBS} $<$<PLATFORM_ID:Windows>:ws2_32>)
if(TWINRAY_SCENE)
    set(scene_uses OpenEXR::OpenEXR ZLIB::ZLIB)
    set(scene_merges "")
    foreach(format ${TWINRAY_FORMATS})
        if(format STREQUAL DRACO)
            list(APPEND scene_merges ${DRACO_LIBRARY})
        else()
            list(APPEND scene_uses ${${format}_LIBRARY})
        endif()
    endforeach()
    twinray_add_library(scene PARTS scene SEES core USES ${scene_uses} MERGES ${scene_merges})
endif()
if(TWINRAY_ANALYSIS)
    twinray_add_library(analysis PARTS analysis SEES scene)
endif()
if(TWINRAY_VALIDATION)
    twinray_add_library(validation PARTS validation SEES core)
endif()

add_library(twinray INTERFACE)
add_library(twinray::twinray ALIAS twinray)
target_link_libraries(twinray INTERFACE ${TWINRAY_LIBRARIES})
