# uwvdb_embed_files(RESULT HEADER TYPE FUNCTION FOLDER FILE...): turns text files into one C++ source,
# so that the program contains them and needs no data folder at run time. RESULT is set to the path of
# the source. It defines `const std::vector<TYPE>& FUNCTION()`, declared in HEADER, with a {name,
# text} of each file, in the order of the files, names relative to FOLDER; it is made anew whenever
# one of them changes.
function(uwvdb_embed_files result header type function folder)
    set(source ${CMAKE_CURRENT_BINARY_DIR}/${function}_data.cpp)
    set(script ${PROJECT_SOURCE_DIR}/cmake/embed_files_script.cmake)
    add_custom_command(
        OUTPUT ${source}
        COMMAND ${CMAKE_COMMAND} -DOUTPUT=${source} -DHEADER=${header} -DTYPE=${type}
                -DFUNCTION=${function} -DFOLDER=${folder} "-DFILES=${ARGN}" -P ${script}
        DEPENDS ${ARGN} ${script}
        COMMENT "Embedding the files of ${function}" VERBATIM)
    set(${result} ${source} PARENT_SCOPE)
endfunction()
