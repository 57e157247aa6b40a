// Shader text: the files under shaders/, compiled into the binary, with #include resolved.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace sfumato::gl {

struct EmbeddedShader {
  std::string_view name;  // path below shaders/, e.g. "lists/insert.glsl"
  std::string_view text;
};

// Every file under shaders/, as it was when the program was built.
const std::vector<EmbeddedShader>& embeddedShaders();

using ShaderDefines = std::vector<std::pair<std::string, std::string>>;  // names and values

struct ShaderSource {
  std::string text;                // complete, starts with #version 430 core
  std::vector<std::string> files;  // files[n] is what the compiler calls source string n
};

// The text of shader `name` with its defines, every `#include "shaders/…"` replaced once by that file (later
// ones by nothing). A file of the same name below `overrideDir` (may be empty) stands in for the built-in
// one. Throws Usage when a file exists nowhere.
ShaderSource resolveShader(const std::string& name, const ShaderDefines& defines,
                           const std::filesystem::path& overrideDir);

// A compiler's log with source string numbers replaced by file names: "3(14)" and "3:14(2)" become
// "lists/insert.glsl:14".
std::string nameFilesInLog(std::string_view log, std::span<const std::string> files);

}  // namespace sfumato::gl
