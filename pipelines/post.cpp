#include "pipelines/post.h"

#include <fmt/ranges.h>

#include <algorithm>

#include "base/error.h"

namespace sfumato::pipelines {
namespace {

// The place of a name among those that a flag takes.
template <typename Choice>
Choice chosen(const char* flag, const std::vector<std::string>& names, const std::string& name) {
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end())
    base::fail(base::ExitCode::Usage, "{} {}: unknown: choose {}", flag, name, fmt::join(names, ", "));
  return static_cast<Choice>(found - names.begin());
}

}  // namespace

const std::vector<std::string>& bloomNames() {
  static const std::vector<std::string> names = {"off", "separable", "mipmap"};
  return names;
}

Bloom bloomNamed(const std::string& name) {
  return chosen<Bloom>("--bloom", bloomNames(), name);
}

const std::vector<std::string>& antiAliasingNames() {
  static const std::vector<std::string> names = {"off", "edges"};
  return names;
}

AntiAliasing antiAliasingNamed(const std::string& name) {
  return chosen<AntiAliasing>("--aa", antiAliasingNames(), name);
}

AovSet aovsFor(const PostOptions& options) {
  return options.antiAliasing == AntiAliasing::Edges ? AovSet{Aov::Depth, Aov::Normal} : AovSet{};
}

}  // namespace sfumato::pipelines
