# Run by embed_shaders.cmake: writes OUTPUT from FILES under ROOT.
set(text "#include \"gl/shader_source.h\"\n\nnamespace sfumato::gl {\n\nconst std::vector<EmbeddedShader>& embeddedShaders() {\n  static const std::vector<EmbeddedShader> all = {\n")
foreach(file IN LISTS FILES)
  file(READ ${ROOT}/${file} content)
  string(APPEND text "{\"${file}\", R\"~GLSL~(${content})~GLSL~\"},\n")
endforeach()
string(APPEND text "  };\n  return all;\n}\n\n}  // namespace sfumato::gl\n")
file(WRITE ${OUTPUT} "${text}")
