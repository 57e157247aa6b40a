#include "gl/profiler.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace sfumato::gl {
namespace {

GLuint stampTime() {
  GLuint query = 0;
  glGenQueries(1, &query);
  glQueryCounter(query, GL_TIMESTAMP);
  return query;
}

// The timestamp in nanoseconds; waits for it and deletes the query.
GLuint64 takeTime(GLuint query) {
  GLuint64 time = 0;
  glGetQueryObjectui64v(query, GL_QUERY_RESULT, &time);
  glDeleteQueries(1, &query);
  return time;
}

}  // namespace

Profiler::Scope::Scope(Profiler& profiler, const std::string& name)
    : profiler_(profiler), prefixLength_(profiler.path_.size()) {
  if (!profiler_.enabled_) return;
  if (!profiler_.path_.empty()) profiler_.path_ += '/';
  profiler_.path_ += name;
  start_ = std::chrono::steady_clock::now();
  startQuery_ = stampTime();
}

Profiler::Scope::~Scope() {
  if (!profiler_.enabled_) return;
  const GLuint endQuery = stampTime();
  glFinish();
  const std::chrono::duration<double, std::milli> wall = std::chrono::steady_clock::now() - start_;
  const GLuint64 start = takeTime(startQuery_);
  const GLuint64 end = takeTime(endQuery);
  PassTime& time = profiler_.entry(profiler_.path_);
  time.gpuMilliseconds += static_cast<double>(end - start) * 1e-6;
  time.wallMilliseconds += wall.count();
  ++time.calls;
  profiler_.path_.resize(prefixLength_);
}

PassTime& Profiler::entry(const std::string& name) {
  const auto found =
      std::find_if(times_.begin(), times_.end(), [&](const PassTime& time) { return time.name == name; });
  if (found != times_.end()) return *found;
  times_.push_back({name});
  return times_.back();
}

}  // namespace sfumato::gl
