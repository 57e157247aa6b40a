# Compiles every file under shaders/ into the binary: a generated .cpp with one raw string for each.
function(sfumato_embed_shaders target)
  file(GLOB_RECURSE files CONFIGURE_DEPENDS RELATIVE ${CMAKE_SOURCE_DIR}/shaders
       ${CMAKE_SOURCE_DIR}/shaders/*.glsl ${CMAKE_SOURCE_DIR}/shaders/*.h ${CMAKE_SOURCE_DIR}/shaders/*.vert
       ${CMAKE_SOURCE_DIR}/shaders/*.geom ${CMAKE_SOURCE_DIR}/shaders/*.frag ${CMAKE_SOURCE_DIR}/shaders/*.comp)
  set(output ${CMAKE_BINARY_DIR}/embedded_shaders.cpp)
  list(TRANSFORM files PREPEND ${CMAKE_SOURCE_DIR}/shaders/ OUTPUT_VARIABLE depends)
  add_custom_command(
    OUTPUT ${output}
    COMMAND ${CMAKE_COMMAND} -DOUTPUT=${output} -DROOT=${CMAKE_SOURCE_DIR}/shaders "-DFILES=${files}"
            -P ${CMAKE_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    DEPENDS ${depends} ${CMAKE_SOURCE_DIR}/cmake/write_embedded_shaders.cmake
    VERBATIM)
  target_sources(${target} PRIVATE ${output})
endfunction()
