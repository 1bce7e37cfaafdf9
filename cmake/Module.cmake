# uwvdb_add_module(FOLDER [NOT_PER_RAY] [USES MODULE...] [LIBRARIES TARGET...] [GENERATED SOURCE...]):
# makes a library of the sources in FOLDER (not of those in its subfolders), named after it:
# core/scene is uwvdb_core_scene. USES lists the modules that it may include, and is what
# scripts/check-layers reads; LIBRARIES are third-party ones that only its sources see. NOT_PER_RAY says
# that nothing in it runs for each ray, pixel or voxel: it is compiled with -O1, which takes two thirds of
# the time.
#
# The linker checks the list as well: the target uwvdb_modules_alone links each module's objects
# once more, as a shared library that must find all of its symbols in the modules of its USES and,
# transitively, in theirs.
add_custom_target(uwvdb_modules_alone)

function(uwvdb_add_module folder)
    cmake_parse_arguments(arg "NOT_PER_RAY" "" "USES;LIBRARIES;GENERATED" ${ARGN})
    string(REPLACE "/" "_" target uwvdb_${folder})
    list(TRANSFORM arg_USES REPLACE "/" "_")
    list(TRANSFORM arg_USES PREPEND "uwvdb_")
    set(uses_alone ${arg_USES})
    list(TRANSFORM uses_alone APPEND "_alone")
    file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/${folder}/*.cpp)
    list(FILTER sources EXCLUDE REGEX "/main\\.cpp$")
    list(APPEND sources ${arg_GENERATED})
    if(NOT sources)
        add_library(${target} INTERFACE)
        target_link_libraries(${target} INTERFACE uwvdb_options ${arg_USES})
        add_library(${target}_alone INTERFACE)
        target_link_libraries(${target}_alone INTERFACE ${uses_alone})
        return()
    endif()
    add_library(${target} STATIC ${sources})
    target_link_libraries(${target} PUBLIC uwvdb_options ${arg_USES} PRIVATE ${arg_LIBRARIES})
    # As few units as the batch size allows, all of about the same number of sources.
    if(CMAKE_UNITY_BUILD AND CMAKE_UNITY_BUILD_BATCH_SIZE)
        list(LENGTH sources number)
        math(EXPR units "(${number} - 1) / ${CMAKE_UNITY_BUILD_BATCH_SIZE} + 1")
        math(EXPR batch "(${number} - 1) / ${units} + 1")
        set_target_properties(${target} PROPERTIES UNITY_BUILD_BATCH_SIZE ${batch})
    endif()
    set_property(GLOBAL APPEND PROPERTY UWVDB_MODULES ${target})
    if(arg_NOT_PER_RAY)
        target_compile_options(${target} PRIVATE $<$<CONFIG:Release>:-O1>)
    endif()

    add_library(${target}_alone SHARED EXCLUDE_FROM_ALL $<TARGET_OBJECTS:${target}>)
    target_link_libraries(${target}_alone
        PUBLIC ${uses_alone} PRIVATE uwvdb_options ${arg_LIBRARIES})
    target_link_options(${target}_alone PRIVATE -Wl,--no-undefined)
    set_target_properties(${target}_alone PROPERTIES LINKER_LANGUAGE CXX)
    add_dependencies(uwvdb_modules_alone ${target}_alone)
endfunction()

# uwvdb_add_loaded_module(NAME COMPONENT LIBRARY SOURCE...): a module that the program loads when it
# needs it (core/image/loaded_module.h), with a library that would cost time at each start; installed
# with the component.
function(uwvdb_add_loaded_module name component library)
    add_library(${name} MODULE ${ARGN})
    target_link_libraries(${name} PRIVATE uwvdb_options ${library})
    set_property(GLOBAL APPEND PROPERTY UWVDB_LOADED_MODULES ${name})
    set_target_properties(${name} PROPERTIES
        PREFIX ""
        LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/${CMAKE_INSTALL_LIBDIR}/uwvdb)
    install(TARGETS ${name}
            LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR}/uwvdb COMPONENT ${component})
endfunction()
