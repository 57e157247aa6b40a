#include "lists/validation/check.h"

#include <algorithm>
#include <numeric>

#include "base/error.h"

namespace sfumato::lists::validation {
namespace {

using Names = std::vector<std::string>;

bool names(const Names& words, const Check& check) {
  return std::any_of(words.begin(), words.end(),
                     [&](const std::string& word) { return word == check.name || word == check.group; });
}

// How many letters must be changed, added or left out to make one of the other (Levenshtein).
size_t distance(std::string_view a, std::string_view b) {
  std::vector<size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), size_t{0});
  for (size_t i = 0; i < a.size(); ++i) {
    size_t diagonal = std::exchange(row[0], i + 1);
    for (size_t j = 0; j < b.size(); ++j) {
      const size_t replaced = diagonal + (a[i] == b[j] ? 0 : 1);
      diagonal = std::exchange(row[j + 1], std::min({replaced, row[j] + 1, row[j + 1] + 1}));
    }
  }
  return row.back();
}

// How far a name is from `word`; one is near that has it as a part.
size_t farness(std::string_view name, std::string_view word) {
  return name.find(word) != std::string_view::npos ? 1 : distance(name, word);
}

[[noreturn]] void failUnknown(const std::vector<Check>& checks, const std::string& word) {
  Names known;
  for (const Check& check : checks) {
    known.push_back(check.name);
    if (std::find(known.begin(), known.end(), check.group) == known.end()) known.push_back(check.group);
  }
  std::stable_sort(known.begin(), known.end(), [&](const std::string& a, const std::string& b) {
    return farness(a, word) < farness(b, word);
  });
  std::string near;
  for (size_t i = 0; i < std::min<size_t>(known.size(), 3); ++i) near += (i == 0 ? "" : ", ") + known[i];
  base::fail(base::ExitCode::Usage, "{}: no such check or group: near are {}: see `sfumato validate --list`",
             word, near);
}

}  // namespace

std::string_view name(Verdict verdict) {
  constexpr std::string_view names[] = {"PASS", "FAIL", "HANG", "CRASH", "SKIP", "NO POWER"};
  return names[static_cast<size_t>(verdict)];
}

std::vector<Check> select(const std::vector<Check>& checks, const Names& only, const Names& skip) {
  for (const Names* words : {&only, &skip})
    for (const std::string& word : *words)
      if (std::none_of(checks.begin(), checks.end(),
                       [&](const Check& check) { return names({word}, check); }))
        failUnknown(checks, word);
  std::vector<Check> selected;
  std::copy_if(checks.begin(), checks.end(), std::back_inserter(selected), [&](const Check& check) {
    return (only.empty() || names(only, check)) && !names(skip, check);
  });
  return selected;
}

}  // namespace sfumato::lists::validation
