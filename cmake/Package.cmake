# `cpack -G DEB` in a build folder makes the .deb of the program and, where it is built, that of the
# Python package, for the system it is built on.
find_package(Git QUIET)
function(uwvdb_of_last_commit result format otherwise)
    set(value "")
    if(GIT_FOUND)
        execute_process(COMMAND ${GIT_EXECUTABLE} log -1 --format=${format}
                        WORKING_DIRECTORY ${PROJECT_SOURCE_DIR}
                        OUTPUT_VARIABLE value OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    endif()
    if(NOT value)
        set(value "${otherwise}")
    endif()
    set(${result} "${value}" PARENT_SCOPE)
endfunction()
uwvdb_of_last_commit(uwvdb_maintainer "%an <%ae>" "uwvdb maintainers <uwvdb@localhost>")
uwvdb_of_last_commit(uwvdb_package_date "%aD" "Thu, 01 Jan 1970 00:00:00 +0000")
string(REGEX MATCH "[0-9][0-9][0-9][0-9]" uwvdb_package_year "${uwvdb_package_date}")

# Packages for different systems have different versions: a newer system's replaces an older one's.
cmake_host_system_information(RESULT uwvdb_system QUERY DISTRIB_INFO)
set(uwvdb_package_release "1~${uwvdb_system_ID}${uwvdb_system_VERSION_ID}")
set(uwvdb_package_version ${PROJECT_VERSION}-${uwvdb_package_release})

foreach(file changelog.Debian copyright)
    configure_file(cmake/debian/${file}.in ${PROJECT_BINARY_DIR}/debian/${file} @ONLY)
    install(FILES ${PROJECT_BINARY_DIR}/debian/${file} DESTINATION ${CMAKE_INSTALL_DOCDIR}
            COMPONENT debian EXCLUDE_FROM_ALL)
    install(FILES ${PROJECT_BINARY_DIR}/debian/${file}
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/python3-uwvdb
            COMPONENT debian_python EXCLUDE_FROM_ALL)
    install(FILES ${PROJECT_BINARY_DIR}/debian/${file}
            DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/uwvdb-doc
            COMPONENT debian_site EXCLUDE_FROM_ALL)
endforeach()

set(CPACK_PACKAGE_NAME uwvdb)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "${uwvdb_maintainer}")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "renderer of physically exact underwater images")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_COMPONENTS_ALL program debian)
set(CPACK_COMPONENTS_GROUPING ONE_PER_GROUP)
set(CPACK_COMPONENT_PROGRAM_GROUP program)
set(CPACK_COMPONENT_DEBIAN_GROUP program)
set(CPACK_DEBIAN_PROGRAM_PACKAGE_NAME uwvdb)
if(TARGET uwvdb_image_formats OR TARGET uwvdb_colour_views)
    list(APPEND CPACK_COMPONENTS_ALL image_formats)
    set(CPACK_COMPONENT_IMAGE_FORMATS_GROUP image_formats)
    set(CPACK_DEBIAN_IMAGE_FORMATS_PACKAGE_NAME uwvdb-image-formats)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS uwvdb-image-formats)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS uwvdb-image-formats)
    set(CPACK_DEBIAN_IMAGE_FORMATS_DESCRIPTION
        "Lets uwvdb read textures in TIFF, Radiance HDR, TGA, BMP, WebP and PSD, write
images in most of these and DPX, by OpenImageIO, and show them through the views of
OpenColorIO configs.")
endif()
if(TARGET uwvdb_fitting)
    list(APPEND CPACK_COMPONENTS_ALL fitting)
    set(CPACK_COMPONENT_FITTING_GROUP fitting)
    set(CPACK_DEBIAN_FITTING_PACKAGE_NAME uwvdb-fitting)
    string(APPEND CPACK_DEBIAN_PROGRAM_PACKAGE_RECOMMENDS ", uwvdb-fitting")
    set(CPACK_DEBIAN_FITTING_DESCRIPTION
        "Lets uwvdb find the port, the water and the lamps of a scene from photographs, by
Ceres and OpenCV.")
endif()
if(UWVDB_MKDOCS AND UWVDB_DOXYGEN)
    list(APPEND CPACK_COMPONENTS_ALL site debian_site)
    set(CPACK_COMPONENT_SITE_GROUP site)
    set(CPACK_COMPONENT_DEBIAN_SITE_GROUP site)
    set(CPACK_DEBIAN_SITE_PACKAGE_NAME uwvdb-doc)
    set(CPACK_DEBIAN_SITE_PACKAGE_SECTION doc)
    set(CPACK_DEBIAN_SITE_PACKAGE_ARCHITECTURE all)
    set(CPACK_DEBIAN_PROGRAM_PACKAGE_SUGGESTS uwvdb-doc)
    set(CPACK_DEBIAN_SITE_DESCRIPTION
        "The documents of uwvdb as a site with search, the reference of its Python
package and of its C++ headers, and notebooks: file:///usr/share/doc/uwvdb/site/index.html")
endif()
if(UWVDB_BUILD_PYTHON)
    list(APPEND CPACK_COMPONENTS_ALL python debian_python)
    set(CPACK_COMPONENT_PYTHON_GROUP python)
    set(CPACK_COMPONENT_DEBIAN_PYTHON_GROUP python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-uwvdb)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS uwvdb)
    set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA ${PROJECT_SOURCE_DIR}/cmake/debian/python/postinst
                                                  ${PROJECT_SOURCE_DIR}/cmake/debian/python/prerm)
    math(EXPR uwvdb_next_python "${Python_VERSION_MINOR} + 1")
    set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
        "python3 (>= 3.${Python_VERSION_MINOR}), python3 (<< 3.${uwvdb_next_python}), python3-numpy")
    set(CPACK_DEBIAN_PYTHON_DESCRIPTION
        "Renders underwater scenes from Python: images, depth and other ground truth
as NumPy arrays, volumes and surfaces from arrays, the rays of cameras behind
ports. The module is called uwvdb.")
endif()
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
    OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_PRE_BUILD_SCRIPTS ${PROJECT_SOURCE_DIR}/cmake/debian/policy_script.cmake)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE ${uwvdb_package_release})
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION
    "Renders what a camera behind a glass port sees of a lamp-lit scene under
water: absorption, scattering and refraction, particle plumes from VDB files,
and exact ground truth beside the image. Example scenes are in
/usr/share/uwvdb/scenes.")
include(CPack)
