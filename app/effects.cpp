#include "app/effects.h"

namespace sfumato::app {

const std::vector<Effects>& allEffects() {
  static const std::vector<Effects> all = {
      {"low", "quarter", 512, 4}, {"medium", "half", 1024, 8}, {"high", "full", 2048, 8}};
  return all;
}

const std::vector<std::string>& effectsNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> result;
    for (const Effects& effects : allEffects()) result.push_back(effects.name);
    return result;
  }();
  return names;
}

}  // namespace sfumato::app
