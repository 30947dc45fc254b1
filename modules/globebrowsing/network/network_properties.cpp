#include "globebrowsing/network/network_properties.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <type_traits>
#include <utility>

namespace meridian::globebrowsing {

namespace {

/// "NetworkCacheSize" as "Network cache size".
std::string wordsOf(std::string_view identifier) {
  std::string words;
  for (const char letter : identifier) {
    const bool isCapital = letter >= 'A' && letter <= 'Z';
    if (isCapital && !words.empty()) {
      words += ' ';
      words += static_cast<char>(letter - 'A' + 'a');
    } else {
      words += letter;
    }
  }
  return words;
}

Property::Description descriptionOf(const NetworkSetting& setting) {
  std::string text(setting.meaning);
  std::erase_if(text, [](char letter) { return letter == '`' || letter == '*'; });  // marks of the documentation
  if (!setting.unit.empty()) {
    text = std::string(setting.unit) + " " + text;
  }
  return {std::string(setting.property), wordsOf(setting.property), std::move(text), !setting.isLive};
}

/// Of what is no whole number of the unit, because the environment said so, the whole part is shown.
int wholeOf(double number) {
  return static_cast<int>(std::floor(number));
}

}  // namespace

NetworkProperties::NetworkProperties(PropertyOwner& owner, NetworkOptions options, Changed changed)
    : options_(std::move(options)), changed_(std::move(changed)) {
  for (const NetworkSetting& setting : networkSettings()) {
    if (!setting.property.empty()) {
      addFor(owner, setting);
    }
  }
}

NetworkProperties::~NetworkProperties() = default;

void NetworkProperties::take(const NetworkSetting& setting, const SettingValue& value) {
  setting.set(options_, value);
  changed_(options_);
}

template <class Kind, class... Arguments>
void NetworkProperties::add(PropertyOwner& owner, const NetworkSetting& setting, Arguments&&... arguments) {
  auto property = std::make_unique<Kind>(descriptionOf(setting), std::forward<Arguments>(arguments)...);
  Kind& added = *property;
  added.onChange([this, &setting, &added] {
    if constexpr (std::is_same_v<Kind, StringProperty>) {
      take(setting, added.get());
    } else {
      take(setting, static_cast<double>(added.get()));
    }
  });
  owner.addProperty(added);
  properties_.push_back(std::move(property));
}

void NetworkProperties::addFor(PropertyOwner& owner, const NetworkSetting& setting) {
  const SettingValue value = setting.get(options_);
  switch (setting.kind) {
    case NetworkSetting::Kind::Count:
    case NetworkSetting::Kind::Bytes:
      add<IntProperty>(owner, setting, wholeOf(std::clamp(std::get<double>(value), setting.minimum, setting.maximum)),
                       static_cast<int>(setting.minimum), static_cast<int>(setting.maximum));
      break;
    case NetworkSetting::Kind::Seconds:
      add<FloatProperty>(owner, setting, std::get<double>(value), NumberRange{setting.minimum, setting.maximum});
      break;
    case NetworkSetting::Kind::Choice: {
      const auto names = cacheModeNames();
      add<OptionProperty>(owner, setting, std::vector<std::string>(names.begin(), names.end()),
                          wholeOf(std::get<double>(value)));
      break;
    }
    case NetworkSetting::Kind::Switch:
      add<BoolProperty>(owner, setting, std::get<double>(value) != 0.0);
      break;
    case NetworkSetting::Kind::Line:
    case NetworkSetting::Kind::Path:
      add<StringProperty>(owner, setting, std::get<std::string>(value), [&setting](const std::string& text) {
        return isAllowed(setting, text) ? std::string() : "give " + setting.values();
      });
      break;
  }
}

}  // namespace meridian::globebrowsing
