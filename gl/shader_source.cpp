#include "gl/shader_source.h"

#include <algorithm>
#include <fstream>
#include <optional>
#include <regex>
#include <sstream>

#include "base/error.h"

namespace sfumato::gl {

using base::ExitCode;
using base::fail;

namespace {

constexpr std::string_view root = "shaders/";

std::string readShader(const std::string& name, const std::filesystem::path& overrideDir) {
  if (!overrideDir.empty()) {
    if (std::ifstream file(overrideDir / name); file) {
      std::ostringstream text;
      text << file.rdbuf();
      return text.str();
    }
  }
  const auto& all = embeddedShaders();
  const auto found =
      std::find_if(all.begin(), all.end(), [&](const EmbeddedShader& shader) { return shader.name == name; });
  if (found == all.end())
    fail(ExitCode::Usage, "shader {}: no such file: check --shader-dir and the #include lines", name);
  return std::string(found->text);
}

// The name in `#include "shaders/NAME"`, when the line is one.
std::optional<std::string> includedName(const std::string& line) {
  static const std::regex pattern(R"(^\s*#\s*include\s+\"([^\"]+)\")");
  std::smatch match;
  if (!std::regex_search(line, match, pattern)) return std::nullopt;
  std::string name = match[1];
  if (name.starts_with(root)) name.erase(0, root.size());
  return name;
}

class Resolver {
 public:
  Resolver(const std::filesystem::path& overrideDir, ShaderSource& source)
      : overrideDir_(overrideDir), source_(source) {}

  void append(const std::string& name) {
    if (std::find(source_.files.begin(), source_.files.end(), name) != source_.files.end()) return;
    const size_t number = source_.files.size();
    source_.files.push_back(name);
    std::istringstream lines(readShader(name, overrideDir_));
    source_.text += fmt::format("#line 1 {}\n", number);
    std::string line;
    for (int row = 1; std::getline(lines, line); ++row) {
      if (const auto included = includedName(line)) {
        append(*included);
        source_.text += fmt::format("#line {} {}\n", row + 1, number);
      } else {
        source_.text += line + '\n';
      }
    }
  }

 private:
  const std::filesystem::path& overrideDir_;
  ShaderSource& source_;
};

}  // namespace

ShaderSource resolveShader(const std::string& name, const ShaderDefines& defines,
                           const std::filesystem::path& overrideDir) {
  ShaderSource source;
  source.text = "#version 430 core\n";
  for (const auto& [key, value] : defines) source.text += fmt::format("#define {} {}\n", key, value);
  Resolver(overrideDir, source).append(name);
  return source;
}

std::string nameFilesInLog(std::string_view log, std::span<const std::string> files) {
  static const std::regex place(R"((^|\n)(\d+)(\((\d+)\)|:(\d+)\(\d+\)))");
  const std::string text(log);
  std::string result;
  auto at = text.cbegin();
  for (std::sregex_iterator match(text.begin(), text.end(), place), end; match != end; ++match) {
    result.append(at, text.cbegin() + match->position());
    const size_t file = std::stoul((*match)[2]);
    const std::string line = (*match)[4].matched ? (*match)[4] : (*match)[5];
    result += (*match)[1].str() + (file < files.size() ? files[file] : (*match)[2].str()) + ":" + line;
    at = text.cbegin() + match->position() + match->length();
  }
  return result.append(at, text.cend());
}

}  // namespace sfumato::gl
