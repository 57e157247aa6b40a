#include "gl/program.h"

#include <epoxy/gl.h>

#include "base/error.h"

namespace sfumato::gl {

using base::ExitCode;
using base::fail;

void deleteProgram(unsigned name) {
  glDeleteProgram(name);
}

namespace {

void deleteShader(unsigned name) {
  glDeleteShader(name);
}

GLenum stageOf(const std::string& name) {
  if (name.ends_with(".vert")) return GL_VERTEX_SHADER;
  if (name.ends_with(".geom")) return GL_GEOMETRY_SHADER;
  if (name.ends_with(".frag")) return GL_FRAGMENT_SHADER;
  if (name.ends_with(".comp")) return GL_COMPUTE_SHADER;
  fail(ExitCode::Bug, "shader {}: its ending names no stage", name);
}

Object<deleteShader> compile(const Device& device, const std::string& name, const ShaderDefines& defines) {
  const ShaderSource source = resolveShader(name, defines, device.shaderDir());
  Object<deleteShader> shader(glCreateShader(stageOf(name)));
  const char* text = source.text.c_str();
  glShaderSource(shader.name(), 1, &text, nullptr);
  glCompileShader(shader.name());
  GLint compiled = GL_FALSE;
  glGetShaderiv(shader.name(), GL_COMPILE_STATUS, &compiled);
  if (compiled == GL_TRUE) return shader;
  GLint length = 0;
  glGetShaderiv(shader.name(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<size_t>(length), '\0');
  glGetShaderInfoLog(shader.name(), length, nullptr, log.data());
  fail(ExitCode::Bug, "shader {}: does not compile: {}", name,
       nameFilesInLog(log.substr(0, 600), source.files));
}

std::vector<BlockMember> members(GLuint program, GLenum interface) {
  GLint count = 0;
  glGetProgramInterfaceiv(program, interface, GL_ACTIVE_RESOURCES, &count);
  std::vector<BlockMember> result;
  for (GLuint i = 0; i < static_cast<GLuint>(count); ++i) {
    const bool storage = interface == GL_BUFFER_VARIABLE;
    const GLenum properties[] = {GL_NAME_LENGTH, GL_OFFSET, GL_TOP_LEVEL_ARRAY_STRIDE};
    GLint values[3] = {0, 0, 0};
    glGetProgramResourceiv(program, interface, i, storage ? 3 : 2, properties, 3, nullptr, values);
    std::string name(static_cast<size_t>(values[0]), '\0');
    glGetProgramResourceName(program, interface, i, values[0], nullptr, name.data());
    name.resize(name.find('\0') == std::string::npos ? name.size() : name.find('\0'));
    if (values[1] >= 0) result.push_back({name, values[1], values[2]});
  }
  return result;
}

}  // namespace

Program::Program(const Device& device, const std::vector<std::string>& names, const ShaderDefines& defines) {
  object_ = Object<deleteProgram>(glCreateProgram());
  for (const std::string& shaderName : names) {
    const auto shader = compile(device, shaderName, defines);
    glAttachShader(name(), shader.name());
  }
  glLinkProgram(name());
  GLint linked = GL_FALSE;
  glGetProgramiv(name(), GL_LINK_STATUS, &linked);
  if (linked == GL_TRUE) return;
  char log[600] = "";
  glGetProgramInfoLog(name(), sizeof log, nullptr, log);
  fail(ExitCode::Bug, "shader {}: does not link: {}", names.back(), log);
}

size_t Program::bytes() const {
  GLint bytes = 0;
  glGetProgramiv(name(), GL_PROGRAM_BINARY_LENGTH, &bytes);
  return static_cast<size_t>(bytes);
}

std::string compileProblem(const Device& device, const std::string& name, const ShaderDefines& defines) {
  try {
    compile(device, name, defines);
    return {};
  } catch (const base::Error& error) {
    return error.what();
  }
}

std::vector<BlockMember> Program::storageMembers() const {
  return members(name(), GL_BUFFER_VARIABLE);
}

std::vector<BlockMember> Program::uniformMembers() const {
  return members(name(), GL_UNIFORM);
}

}  // namespace sfumato::gl
