# Flags every target of the project is built with; third-party headers are SYSTEM and exempt.
add_library(uwvdb_options INTERFACE)
target_link_libraries(uwvdb_options INTERFACE glm::glm fmt::fmt)
target_compile_options(uwvdb_options INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    # a*b+c is never fused by the compiler: the same scene gives the same bits on every build
    -ffp-contract=off
    # assertions name files as they lie in the repository, wherever that is
    -ffile-prefix-map=${PROJECT_SOURCE_DIR}/=
    # Allows inlining in the position-independent code of the library as elsewhere
    -fno-semantic-interposition)
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU)
    # The compiler collects its garbage from 0.8 GB on, not from 0.25 GB on, which saves a tenth of its time.
    # The largest unit takes 1.4 GB either way.
    target_compile_options(uwvdb_options INTERFACE "SHELL:--param ggc-min-heapsize=400000")
endif()
if(CMAKE_CXX_COMPILER_ID STREQUAL GNU AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # GCC 12 takes "text" + a_string, once inlined, for a copy that overlaps (its bug 105651).
    target_compile_options(uwvdb_options INTERFACE -Wno-restrict)
    # Only with this compiler, Debian 12's, whose warnings are the same everywhere: what a later one
    # finds must not keep anyone from building.
    if(UWVDB_WARNINGS_AS_ERRORS)
        target_compile_options(uwvdb_options INTERFACE -Werror)
    endif()
endif()
if(UWVDB_SANITIZE)
    target_compile_options(uwvdb_options INTERFACE -fsanitize=${UWVDB_SANITIZE})
    target_link_options(uwvdb_options INTERFACE -fsanitize=${UWVDB_SANITIZE})
endif()
target_include_directories(uwvdb_options INTERFACE ${PROJECT_SOURCE_DIR})

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()
