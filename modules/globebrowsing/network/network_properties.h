#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "globebrowsing/network/network_settings.h"
#include "host/api/property.h"
#include "host/api/property_owner.h"

namespace meridian::globebrowsing {

/// The properties of networkSettings(). Render thread only.
class NetworkProperties {
 public:
  using Changed = std::function<void(const NetworkOptions&)>;

  /// Adds them to `owner`, which outlives this, with `options` as their values. `changed` is called after each change,
  /// with the options as they are then.
  NetworkProperties(PropertyOwner& owner, NetworkOptions options, Changed changed);
  NetworkProperties(const NetworkProperties&) = delete;
  NetworkProperties& operator=(const NetworkProperties&) = delete;
  ~NetworkProperties();

  [[nodiscard]] const NetworkOptions& options() const { return options_; }

 private:
  template <class Kind, class... Arguments>
  void add(PropertyOwner& owner, const NetworkSetting& setting, Arguments&&... arguments);
  void addFor(PropertyOwner& owner, const NetworkSetting& setting);
  void take(const NetworkSetting& setting, const SettingValue& value);

  NetworkOptions options_;
  Changed changed_;
  std::vector<std::unique_ptr<Property>> properties_;
};

}  // namespace meridian::globebrowsing
