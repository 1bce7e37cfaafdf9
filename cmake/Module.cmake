# uwvdb_add_module(FOLDER [USES MODULE...] [LIBRARIES TARGET...] [GENERATED SOURCE...]):
# makes a library of the sources in FOLDER (not of those in its subfolders), named after it:
# core/scene/yaml is uwvdb_core_scene_yaml. USES lists the modules that it may include, and is what
# scripts/check-layers reads; LIBRARIES are third-party ones that only its sources see.
#
# With UWVDB_SHARED_MODULES each module is a shared library that must find all of its symbols in what it
# links, so that the linker checks the list as well.
function(uwvdb_add_module folder)
    cmake_parse_arguments(arg "" "" "USES;LIBRARIES;GENERATED" ${ARGN})
    string(REPLACE "/" "_" target uwvdb_${folder})
    list(TRANSFORM arg_USES REPLACE "/" "_")
    list(TRANSFORM arg_USES PREPEND "uwvdb_")
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
    list(APPEND sources ${arg_GENERATED})
    if(NOT sources)
        add_library(${target} INTERFACE)
        target_link_libraries(${target} INTERFACE uwvdb_options ${arg_USES})
        return()
    endif()
    if(UWVDB_SHARED_MODULES)
        add_library(${target} SHARED ${sources})
    else()
        add_library(${target} STATIC ${sources})
    endif()
    target_link_libraries(${target} PUBLIC uwvdb_options ${arg_USES} PRIVATE ${arg_LIBRARIES})
    if(UWVDB_SHARED_MODULES)
        target_link_options(${target} PRIVATE -Wl,--no-undefined)
    endif()
    set_property(GLOBAL APPEND PROPERTY UWVDB_MODULES ${target})
endfunction()
