# What `cmake --install` installs: the program with its documents, example scenes, man page and shell
# completions (component "program"), and for C++ users a shared library with its headers and
# find_package(uwvdb) (component "development").
include(CMakePackageConfigHelpers)
include(PublicHeaders)

install(TARGETS uwvdb RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT program)
install(FILES README.md CHANGELOG.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT program)
install(DIRECTORY assets/cameras assets/grids assets/ies assets/meshes assets/profiles assets/scenes
        DESTINATION ${CMAKE_INSTALL_DATADIR}/uwvdb COMPONENT program)

# Installs as FILE what the program prints when run with the remaining arguments.
function(uwvdb_install_printed file folder)
    set(printed ${PROJECT_BINARY_DIR}/printed/${folder}/${file})
    cmake_path(GET printed PARENT_PATH printed_folder)
    file(MAKE_DIRECTORY ${printed_folder})
    add_custom_command(OUTPUT ${printed} COMMAND uwvdb ${ARGN} > ${printed}
                       COMMENT "Printing ${file}" VERBATIM)
    set_property(GLOBAL APPEND PROPERTY UWVDB_PRINTED ${printed})
    install(FILES ${printed} DESTINATION ${folder} COMPONENT program)
endfunction()

uwvdb_install_printed(uwvdb.1 ${CMAKE_INSTALL_MANDIR}/man1 man)
uwvdb_install_printed(uwvdb ${CMAKE_INSTALL_DATADIR}/bash-completion/completions completion bash)
uwvdb_install_printed(_uwvdb ${CMAKE_INSTALL_DATADIR}/zsh/site-functions completion zsh)
uwvdb_install_printed(uwvdb.fish ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d
                      completion fish)
get_property(uwvdb_printed GLOBAL PROPERTY UWVDB_PRINTED)
add_custom_target(uwvdb_printed ALL DEPENDS ${uwvdb_printed})

# The Blender add-on, as Blender installs it.
file(GLOB uwvdb_blender_files CONFIGURE_DEPENDS python/blender/uwvdb_blender/*.py
     python/blender/uwvdb_blender/*.toml)
set(uwvdb_blender_addon ${PROJECT_BINARY_DIR}/blender/uwvdb_blender.zip)
add_custom_command(OUTPUT ${uwvdb_blender_addon}
    COMMAND ${PROJECT_SOURCE_DIR}/scripts/blender-addon ${uwvdb_blender_addon}
    DEPENDS ${uwvdb_blender_files} scripts/blender-addon LICENSE
    COMMENT "Packing the Blender add-on" VERBATIM)
add_custom_target(uwvdb_blender_addon ALL DEPENDS ${uwvdb_blender_addon})
install(FILES ${uwvdb_blender_addon} DESTINATION ${CMAKE_INSTALL_DATADIR}/uwvdb/blender
        COMPONENT program)

# The documents as a site, made when it is installed: component "site", for packages and bundles, which
# scripts/docs-site makes where its programs are.
find_program(UWVDB_MKDOCS mkdocs)
find_program(UWVDB_DOXYGEN doxygen)
if(UWVDB_MKDOCS AND UWVDB_DOXYGEN)
    install(CODE "execute_process(
        COMMAND \"${PROJECT_SOURCE_DIR}/scripts/docs-site\"
                \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DOCDIR}/site\"
        COMMAND_ERROR_IS_FATAL ANY)" COMPONENT site EXCLUDE_FROM_ALL)
endif()

# The library, without what only commands and Python use. Between minor versions, anything may change.
get_property(uwvdb_library_modules GLOBAL PROPERTY UWVDB_MODULES)
list(FILTER uwvdb_library_modules INCLUDE REGEX "^uwvdb_(core|media|camera|render)")
list(FILTER uwvdb_library_modules EXCLUDE REGEX "^uwvdb_render_(run|validation)$")
list(TRANSFORM uwvdb_library_modules REPLACE "(.+)" "$<TARGET_OBJECTS:\\1>"
     OUTPUT_VARIABLE uwvdb_library_objects)
uwvdb_public_headers(uwvdb_headers_to_install core media camera render)
add_library(uwvdb_library SHARED ${uwvdb_library_objects})
# All objects are in it already; linked for the libraries that they need.
target_link_libraries(uwvdb_library PRIVATE ${uwvdb_library_modules} INTERFACE glm::glm)
target_compile_features(uwvdb_library INTERFACE cxx_std_20)
target_sources(uwvdb_library INTERFACE
    FILE_SET HEADERS BASE_DIRS ${PROJECT_SOURCE_DIR} FILES ${uwvdb_headers_to_install})
set_target_properties(uwvdb_library PROPERTIES
    LINKER_LANGUAGE CXX
    OUTPUT_NAME uwvdb
    EXPORT_NAME uwvdb
    VERSION ${PROJECT_VERSION}
    SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
install(TARGETS uwvdb_library EXPORT uwvdbTargets
    LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT development
    FILE_SET HEADERS DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/uwvdb COMPONENT development)

# All that is installed, whatever else is configured, such as tests: what scripts/demo builds.
get_property(uwvdb_loaded_modules GLOBAL PROPERTY UWVDB_LOADED_MODULES)
add_custom_target(uwvdb_installed)
add_dependencies(uwvdb_installed uwvdb uwvdb_library uwvdb_printed uwvdb_blender_addon
                 ${uwvdb_loaded_modules})

set(uwvdb_package_folder ${CMAKE_INSTALL_LIBDIR}/cmake/uwvdb)
configure_package_config_file(cmake/uwvdbConfig.cmake.in ${PROJECT_BINARY_DIR}/uwvdbConfig.cmake
                              INSTALL_DESTINATION ${uwvdb_package_folder})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/uwvdbConfigVersion.cmake
                                 COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/uwvdbConfig.cmake
              ${PROJECT_BINARY_DIR}/uwvdbConfigVersion.cmake cmake/Glm.cmake
        DESTINATION ${uwvdb_package_folder} COMPONENT development)
install(EXPORT uwvdbTargets NAMESPACE uwvdb:: DESTINATION ${uwvdb_package_folder}
        COMPONENT development)
