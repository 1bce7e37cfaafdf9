# The version users see in `uwvdb --version` and in image headers: the release, plus the commit
# when built from a checkout, as long in every clone.
set(UWVDB_VERSION_STRING ${PROJECT_VERSION})
find_package(Git QUIET)
if(GIT_FOUND)
    execute_process(COMMAND ${GIT_EXECUTABLE} rev-parse --short=10 HEAD
                    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                    OUTPUT_VARIABLE uwvdb_commit OUTPUT_STRIP_TRAILING_WHITESPACE
                    ERROR_QUIET RESULT_VARIABLE uwvdb_git_result)
    if(uwvdb_git_result EQUAL 0)
        string(APPEND UWVDB_VERSION_STRING "+${uwvdb_commit}")
    endif()
endif()

# What `uwvdb --version` says it was built with.
string(JOIN ", " UWVDB_LIBRARIES
       "OpenVDB ${OpenVDB_VERSION}" "Embree ${embree_VERSION}" "OpenEXR ${OpenEXR_VERSION}"
       "oneTBB ${TBB_VERSION}" "FFTW ${FFTW_VERSION}" "libpng ${PNG_VERSION_STRING}"
       "libjpeg ${JPEG_VERSION}" "zlib ${ZLIB_VERSION_STRING}" "yaml-cpp ${yaml-cpp_VERSION}"
       "cpp-httplib ${HTTPLIB_VERSION}")
if(OpenImageIO_FOUND)
    string(APPEND UWVDB_LIBRARIES ", OpenImageIO ${OpenImageIO_VERSION}")
endif()
if(Ceres_FOUND)
    string(APPEND UWVDB_LIBRARIES ", Ceres ${Ceres_VERSION}")
endif()
string(APPEND UWVDB_LIBRARIES ", ${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
