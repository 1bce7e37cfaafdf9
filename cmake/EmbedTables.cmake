# Turns assets/spectra/*.csv into one C++ source, so that the program contains its tables and needs
# no data folder at run time: `embedded_table("name.csv")` of core/tables/embedded_tables.h.
set(UWVDB_EMBEDDED_TABLES ${CMAKE_CURRENT_BINARY_DIR}/embedded_tables_data.cpp)
file(GLOB uwvdb_tables CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/assets/spectra/*.csv)
add_custom_command(
    OUTPUT ${UWVDB_EMBEDDED_TABLES}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${UWVDB_EMBEDDED_TABLES}
            "-DTABLES=${uwvdb_tables}" -P ${PROJECT_SOURCE_DIR}/cmake/embed_tables_script.cmake
    DEPENDS ${uwvdb_tables} ${PROJECT_SOURCE_DIR}/cmake/embed_tables_script.cmake
    COMMENT "Embedding the spectral tables" VERBATIM)
