#include "lists/validation/run_here_gpu.h"

#include "base/error.h"

namespace sfumato::lists::validation {
namespace {

// A compiler's log has more lines; the first says what is wrong.
std::string firstLine(const std::string& text) {
  return text.substr(0, text.find('\n'));
}

Result guarded(const Check& check, const Context& context) {
  try {
    return check.run(context);
  } catch (const base::Error& error) {
    if (error.exitCode == base::ExitCode::Memory) return {Verdict::Skip, firstLine(error.what()), {}, {}};
    return {Verdict::Fail, firstLine(error.what()), "such code does not even start on this driver", {}};
  }
}

}  // namespace

Result runHere(const Check& check, const Here& here) {
  gl::DeviceOptions options = here.device;
  options.examine = true;
  gl::Device device(options);
  Result result = guarded(check, {device, here.seed, here.scale, here.mutant, here.again});
  const gl::Reset reset = device.resetStatus();
  if (reset == gl::Reset::None) return result;
  result.verdict = Verdict::Crash;
  result.finding =
      fmt::format("the driver reset the context{}", reset == gl::Reset::Guilty     ? ", and blames it"
                                                    : reset == gl::Reset::Innocent ? ", and blames another"
                                                                                   : "");
  result.meaning = "what such code leaves behind is undefined on this driver";
  return result;
}

}  // namespace sfumato::lists::validation
