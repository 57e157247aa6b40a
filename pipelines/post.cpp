#include "pipelines/post.h"

namespace sfumato::pipelines {

const base::Choice<Bloom>& blooms() {
  static const base::Choice<Bloom> choice{"--bloom", {"off", "separable", "mipmap"}};
  return choice;
}

const base::Choice<AntiAliasing>& antiAliasings() {
  static const base::Choice<AntiAliasing> choice{"--aa", {"off", "edges"}};
  return choice;
}

AovSet aovsFor(const PostOptions& options) {
  return options.antiAliasing == AntiAliasing::Edges ? AovSet{Aov::Depth, Aov::Normal} : AovSet{};
}

}  // namespace sfumato::pipelines
