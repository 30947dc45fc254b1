#include "host/scene/lua_transforms.h"

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <glm/gtc/quaternion.hpp>

#include "host/api/log.h"
#include "host/api/regular_file.h"
#include "host/api/schema.h"
#include "host/scene/transform_types.h"
#include "host/scripting/script_engine.h"

namespace meridian::scene {

namespace {

namespace fs = std::filesystem;

/// A call has to fit into a frame.
constexpr scripting::ScriptLimits limits{std::size_t{16} << 20, 1'000'000};

/// One script's state, and what its function last returned.
class TransformScript {
 public:
  static Result<std::unique_ptr<TransformScript>> open(const TransformRequest& request, std::string function) {
    static const Schema schema({{"Script", Schema::Type::String, "Path of a Lua file", true}});
    if (auto valid = schema.validate(request.table, request.where, request.path); !valid) {
      return tl::make_unexpected(valid.error());
    }
    fs::path file(*request.table.find("Script")->string());
    file = file.is_absolute() ? file : fs::path(request.folder) / file;
    const Result<std::string> text = readRegularFile(file, largestText, "the script", "check its path");
    if (!text) {
      return failure(text.error().what, request.place("Script") + ": " + file.string(), text.error().remedy);
    }
    std::unique_ptr<TransformScript> script(new TransformScript(std::move(function)));
    if (auto done = script->engine_.run(*text, file.string()); !done) {
      return tl::make_unexpected(done.error());
    }
    return script;
  }

  /// All numbers that the function returns, in a table or side by side, if they are `count` or `otherCount` many.
  /// Before the first success: nothing.
  [[nodiscard]] const std::vector<double>& numbersAt(const Time& time, std::size_t count, std::size_t otherCount = 0) {
    if (last_ && *last_ - time == 0.0) {
      return numbers_;
    }
    const double now = time.tdbSeconds();
    const auto values = engine_.evaluate(
        fmt::format("{}({}, {}, {})", function_, now, last_ ? last_->tdbSeconds() : now, Time::now().tdbSeconds()),
        function_);
    last_ = time;
    std::vector<double> found;
    for (const Value& value : values ? *values : std::vector<Value>()) {
      const auto several = value.number() ? std::vector<double>{*value.number()} : value.numbers();
      found.insert(found.end(), several ? several->begin() : found.end(), several ? several->end() : found.end());
    }
    const bool finite = std::all_of(found.begin(), found.end(), [](double number) { return std::isfinite(number); });
    if (finite && !found.empty() && (found.size() == count || found.size() == otherCount)) {
      numbers_ = std::move(found);
    } else if (!std::exchange(failed_, true)) {
      log::warning("{}", values ? fmt::format("the function {} returned {} finite numbers instead of {}", function_,
                                              found.size(), count)
                                : values.error().message());
    }
    return numbers_;
  }

 private:
  explicit TransformScript(std::string function) : engine_(limits), function_(std::move(function)) {}

  scripting::ScriptEngine engine_;
  std::string function_;
  std::optional<Time> last_;
  std::vector<double> numbers_;
  bool failed_ = false;
};

class LuaTranslation final : public Translation {
 public:
  explicit LuaTranslation(std::unique_ptr<TransformScript> script) : script_(std::move(script)) {}
  [[nodiscard]] glm::dvec3 position(const Time& time) const override {
    const std::vector<double>& n = script_->numbersAt(time, 3);
    return n.empty() ? glm::dvec3(0.0) : glm::dvec3(n[0], n[1], n[2]);
  }

 private:
  std::unique_ptr<TransformScript> script_;
};

class LuaRotation final : public Rotation {
 public:
  explicit LuaRotation(std::unique_ptr<TransformScript> script) : script_(std::move(script)) {}
  [[nodiscard]] glm::dmat3 matrix(const Time& time) const override {
    const std::vector<double>& n = script_->numbersAt(time, 9);
    if (n.empty()) {
      return glm::dmat3(1.0);
    }
    // The nearest rotation: what a script computes is not orthonormal to the last bit, or not at all.
    const glm::dquat rotation = glm::quat_cast(glm::dmat3(n[0], n[1], n[2], n[3], n[4], n[5], n[6], n[7], n[8]));
    const double length = glm::length(rotation);
    return std::isfinite(length) && length > 0.0 ? glm::mat3_cast(rotation / length) : glm::dmat3(1.0);
  }

 private:
  std::unique_ptr<TransformScript> script_;
};

class LuaScale final : public Scale {
 public:
  explicit LuaScale(std::unique_ptr<TransformScript> script) : script_(std::move(script)) {}
  [[nodiscard]] double factor(const Time& time) const override {
    const std::vector<double>& n = script_->numbersAt(time, 1, 3);
    if (n.empty()) {
      return 1.0;
    }
    return usableScale(n.size() == 1 ? n[0] : std::cbrt(std::abs(n[0] * n[1] * n[2])));
  }

 private:
  std::unique_ptr<TransformScript> script_;
};

}  // namespace

Result<std::unique_ptr<Translation>> makeLuaTranslation(const TransformRequest& request) {
  return TransformScript::open(request, "translation").map([](auto script) {
    return std::make_unique<LuaTranslation>(std::move(script));
  });
}

Result<std::unique_ptr<Rotation>> makeLuaRotation(const TransformRequest& request) {
  return TransformScript::open(request, "rotation").map([](auto script) {
    return std::make_unique<LuaRotation>(std::move(script));
  });
}

Result<std::unique_ptr<Scale>> makeLuaScale(const TransformRequest& request) {
  return TransformScript::open(request, "scale").map([](auto script) {
    return std::make_unique<LuaScale>(std::move(script));
  });
}

}  // namespace meridian::scene
