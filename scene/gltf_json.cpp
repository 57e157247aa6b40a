#include "scene/gltf_json.h"

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>
#include <vector>

#include "base/error.h"
#include "scene/printable.h"

namespace sfumato::scene {
namespace {

using Json = nlohmann::json;

constexpr size_t maxDepth = 128;
constexpr size_t maxValues = size_t{1} << 23;

// Walks the text once; the first fault stops it.
class Guard : public nlohmann::json_sax<Json> {
 public:
  std::string fault;

  bool null() override { return countValue(); }
  bool boolean(bool) override { return countValue(); }
  bool string(string_t&) override { return countValue(); }
  bool binary(binary_t&) override { return countValue(); }
  bool number_float(number_float_t, const string_t& value) override {
    return isByteCount() ? notAByteCount(value) : countValue();
  }
  bool number_integer(number_integer_t value) override {  // negative ones only
    if (isByteCount()) return notAByteCount(std::to_string(value));
    return value >= std::numeric_limits<int32_t>::min() ? countValue() : beyond32Bits(std::to_string(value));
  }
  bool number_unsigned(number_unsigned_t value) override {
    return value <= std::numeric_limits<int32_t>::max() ? countValue() : beyond32Bits(std::to_string(value));
  }

  bool key(string_t& name) override {
    keys_.back() = name;
    if (inBuffer() && name == "uri") bufferHasUri_ = true;
    return true;
  }

  bool start_object(size_t) override {
    if (!open()) return false;
    if (inBuffer()) bufferHasUri_ = false;
    return true;
  }

  bool end_object() override {
    if (inBuffer() && buffers_++ > 0 && !bufferHasUri_)
      return stop(fmt::format("buffer {} has no uri, which only the first may lack", buffers_ - 1));
    keys_.pop_back();
    return true;
  }

  bool start_array(size_t) override { return open(); }
  bool end_array() override {
    keys_.pop_back();
    return true;
  }

  bool parse_error(size_t, const std::string&, const nlohmann::detail::exception& error) override {
    return stop(printable(error.what(), 300));
  }

 private:
  bool stop(std::string what) {
    fault = std::move(what);
    return false;
  }

  bool countValue() {
    return ++values_ <= maxValues || stop(fmt::format("has more than {} JSON values", maxValues));
  }

  bool open() {
    keys_.emplace_back();
    if (keys_.size() > maxDepth) return stop(fmt::format("JSON is nested deeper than {} levels", maxDepth));
    return countValue();
  }

  bool beyond32Bits(const std::string& value) {
    const std::string& name = keys_.empty() ? value : keys_.back();
    if (name.starts_with("volume_") || name == "emissiveStrength" || name == "rotation")
      return stop(fmt::format("integer {} of \"{}\" is beyond 32 bits: write it with a decimal point", value,
                              printable(name)));
    return countValue();
  }

  // tinygltf would take an optional one that is wrong for 0.
  bool isByteCount() const {
    return !keys_.empty() &&
           (keys_.back() == "byteOffset" || keys_.back() == "byteLength" || keys_.back() == "byteStride");
  }
  bool notAByteCount(const std::string& value) {
    return stop(fmt::format("{} of \"{}\" is not a number of bytes", value, keys_.back()));
  }

  // Inside {"buffers": [{ here }]}.
  bool inBuffer() const { return keys_.size() == 3 && keys_[0] == "buffers"; }

  std::vector<std::string> keys_;  // for each open object its last key, for each open array nothing
  size_t values_ = 0;
  size_t buffers_ = 0;
  bool bufferHasUri_ = false;
};

}  // namespace

void checkGltfJson(std::string_view json, const std::string& path) {
  Guard guard;
  if (!Json::sax_parse(json.begin(), json.end(), &guard))
    base::fail(base::ExitCode::Input, "{}: {}: export the file again", path, guard.fault);
}

}  // namespace sfumato::scene
