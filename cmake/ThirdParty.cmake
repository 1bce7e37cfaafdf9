# Every third-party library, found once. All come from the distribution's packages.
find_package(Threads REQUIRED)
find_package(TBB REQUIRED)
include(Glm)
# The same preference as in core/geometry/embree_api.h.
find_package(embree 4 QUIET)
if(NOT embree_FOUND)
    find_package(embree 3 REQUIRED)
endif()
find_package(yaml-cpp REQUIRED)
find_package(fmt REQUIRED)
find_package(OpenEXR REQUIRED)
find_package(PNG REQUIRED)
find_package(ZLIB REQUIRED)
find_package(JPEG REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(nanoflann REQUIRED)
find_package(CLI11 QUIET)
if(NOT TARGET CLI11::CLI11)
    find_path(CLI11_INCLUDE_DIR CLI/CLI.hpp REQUIRED)
    add_library(CLI11::CLI11 INTERFACE IMPORTED)
    set_target_properties(CLI11::CLI11 PROPERTIES INTERFACE_INCLUDE_DIRECTORIES ${CLI11_INCLUDE_DIR})
endif()

# FFTW has no CMake package. Its threads are not used: ours split the work.
find_path(FFTW3_INCLUDE_DIR fftw3.h REQUIRED)
find_library(FFTW3_LIBRARY fftw3 REQUIRED)
add_library(uwvdb_fftw INTERFACE)
target_include_directories(uwvdb_fftw SYSTEM INTERFACE ${FFTW3_INCLUDE_DIR})
target_link_libraries(uwvdb_fftw INTERFACE ${FFTW3_LIBRARY})

# OpenVDB ships find modules, not a package config; their folder names the architecture.
# They require Boost, which CMake is to find by Boost's own package config.
set(CMAKE_POLICY_DEFAULT_CMP0167 NEW)
file(GLOB UWVDB_OPENVDB_MODULES /usr/lib/*/cmake/OpenVDB /usr/lib/cmake/OpenVDB
     /usr/local/lib/cmake/OpenVDB)
list(APPEND CMAKE_MODULE_PATH ${UWVDB_OPENVDB_MODULES})
find_package(OpenVDB REQUIRED)
find_path(NANOVDB_INCLUDE_DIR nanovdb/NanoVDB.h REQUIRED)
add_library(uwvdb_nanovdb INTERFACE)
target_include_directories(uwvdb_nanovdb SYSTEM INTERFACE ${NANOVDB_INCLUDE_DIR})
target_link_libraries(uwvdb_nanovdb INTERFACE OpenVDB::openvdb)
# Its conversions and checksums run on all threads; one setting for all files, unity or not.
target_compile_definitions(uwvdb_nanovdb INTERFACE NANOVDB_USE_TBB)

# cpp-httplib as the distributions build it; what its header declares depends on flags that its
# pkg-config file alone names.
find_package(PkgConfig REQUIRED)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
if(HTTPLIB_VERSION VERSION_GREATER_EQUAL 0.15)  # Debian 13's: threads in its header end OpenSSL's part of them
    find_package(OpenSSL REQUIRED)              # libcpp-httplib-dev depends on libssl-dev
    target_link_libraries(PkgConfig::HTTPLIB INTERFACE OpenSSL::Crypto)
endif()
pkg_check_modules(FFTW QUIET fftw3)  # its version

# Only for the module image_formats, and for tests. The exported target names an OpenCV include
# folder that its package does not provide.
find_package(OpenImageIO QUIET)
if(OpenImageIO_FOUND)
    get_target_property(uwvdb_oiio_includes OpenImageIO::OpenImageIO INTERFACE_INCLUDE_DIRECTORIES)
    list(FILTER uwvdb_oiio_includes EXCLUDE REGEX opencv)
    set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
                          INTERFACE_INCLUDE_DIRECTORIES "${uwvdb_oiio_includes}")
endif()

# Only for the module colour_views, and for tests.
pkg_check_modules(OPENCOLORIO IMPORTED_TARGET OpenColorIO)

# Only for the module fitting. OpenCV's CMake package is that of all its modules.
find_package(Ceres 2.1 QUIET)
find_path(OPENCV_INCLUDE_DIR opencv2/calib3d.hpp PATH_SUFFIXES opencv4)
find_library(OPENCV_CALIB3D_LIBRARY opencv_calib3d)
find_library(OPENCV_CORE_LIBRARY opencv_core)
if(Ceres_FOUND AND OPENCV_INCLUDE_DIR AND OPENCV_CALIB3D_LIBRARY AND OPENCV_CORE_LIBRARY)
    add_library(uwvdb_fit_libraries INTERFACE)
    target_include_directories(uwvdb_fit_libraries SYSTEM INTERFACE ${OPENCV_INCLUDE_DIR})
    target_link_libraries(uwvdb_fit_libraries INTERFACE
        Ceres::ceres ${OPENCV_CALIB3D_LIBRARY} ${OPENCV_CORE_LIBRARY})
endif()

# The system's interpreter, of which the packages pybind11 and NumPy are, whatever else is in PATH.
if(UWVDB_BUILD_PYTHON)
    if(NOT Python_EXECUTABLE AND EXISTS /usr/bin/python3)
        set(Python_EXECUTABLE /usr/bin/python3)
    endif()
    find_package(Python 3.11 REQUIRED COMPONENTS Interpreter Development.Module)
    find_package(pybind11 2.10 REQUIRED)
endif()
