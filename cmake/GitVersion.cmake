# The version users see in `uwvdb --version` and in image headers: the release, plus the commit
# when built from a checkout.
set(UWVDB_VERSION_STRING ${PROJECT_VERSION})
find_package(Git QUIET)
if(GIT_FOUND)
    execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --short HEAD
                    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                    OUTPUT_VARIABLE uwvdb_commit OUTPUT_STRIP_TRAILING_WHITESPACE
                    ERROR_QUIET RESULT_VARIABLE uwvdb_git_result)
    if(uwvdb_git_result EQUAL 0)
        string(APPEND UWVDB_VERSION_STRING "+${uwvdb_commit}")
    endif()
endif()
