# uwvdb_check_headers(target FOLDERS ... LIBRARIES ...): compiles every header below FOLDERS alone,
# twice over, so that each one includes what it uses and guards itself.
function(uwvdb_check_headers target)
    cmake_parse_arguments(arg "" "" "FOLDERS;LIBRARIES" ${ARGN})
    list(TRANSFORM arg_FOLDERS APPEND "/*.h")
    list(TRANSFORM arg_FOLDERS PREPEND "${PROJECT_SOURCE_DIR}/")
    file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${arg_FOLDERS})
    set(sources "")
    foreach(header IN LISTS headers)
        set(source ${CMAKE_CURRENT_BINARY_DIR}/${target}/${header}.cpp)
        file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\"\n")
        list(APPEND sources ${source})
    endforeach()
    add_library(${target} OBJECT ${sources})
    target_link_libraries(${target} PRIVATE ${arg_LIBRARIES})
    # Nothing is linked from it: the cheapest object files will do.
    target_compile_options(${target} PRIVATE -O0 -g0)
endfunction()
