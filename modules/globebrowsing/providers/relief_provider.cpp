#include "globebrowsing/providers/relief_provider.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "globebrowsing/providers/default_tile_provider.h"
#include "globebrowsing/providers/inner_providers.h"
#include "globebrowsing/source/document_file.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

constexpr double degree = std::numbers::pi / 180.0;
/// Longer files are no colour ramps.
constexpr std::size_t longestRampFile = std::size_t{1} << 20;
constexpr NumberRange azimuthRange{0.0, 360.0};
constexpr NumberRange altitudeRange{0.0, 90.0};
constexpr NumberRange zFactorRange{0.0, 1000.0};
constexpr NumberRange intervalRange{0.01, 100'000.0};
constexpr NumberRange widthRange{0.5, 32.0};
constexpr NumberRange unitRange{0.0, 1.0};
constexpr std::string_view greyRamp = "0% black; 100% white";
constexpr std::string_view darkRamp = "0% white; 100% black";

Schema::Field numberField(std::string key, std::string description, const NumberRange& range) {
  return {std::move(key), Schema::Type::Number, std::move(description), false, range.minimum, range.maximum};
}

void take(const Value& table, std::string_view key, FloatProperty& into) {
  into.put(valueAt(table, key).number().value_or(into.get()));
}

/// Whether it is a ramp at all, whatever its percentages mean.
Result<void> checkRamp(const std::string& text, const std::string& where) {
  const Result<ColourRamp> ramp = readColourRamp(text, {0.0, 1.0});
  return ramp ? Result<void>() : failure(ramp.error().what, where, ramp.error().remedy);
}

}  // namespace

const ReliefStyle* ReliefProvider::relief() {
  if (!hasTaken_ && state() == State::Ready) {
    hasTaken_ = true;
    takeOpened();
    isStyled_ = false;
  }
  if (!isStyled_) {
    isStyled_ = true;
    restyle();
  }
  return &style_;
}

void ReliefProvider::add(Property& property) {
  owner_.addProperty(property);
  property.onChange([this] { isStyled_ = false; });
}

const Schema& RampProvider::schema() {
  using Type = Schema::Type;
  static const Schema fields(
      {{"ColorRamp", Type::String, "values and their colours, as gdaldem color-relief takes them; ; ends a line too"},
       {"ColorRampFile", Type::String, "a file with them, relative to the asset's folder or absolute"},
       {"Range", Type::Vector2, "the values that 0% and 100% mean in them: metres, or degrees of slope"}});
  return fields;
}

Result<std::shared_ptr<TileProvider>> RampProvider::makeColourRelief(const ProviderRequest& request) {
  return make(request, ReliefKind::ColorRelief);
}

Result<std::shared_ptr<TileProvider>> RampProvider::makeSlope(const ProviderRequest& request) {
  return make(request, ReliefKind::Slope);
}

Result<std::shared_ptr<TileProvider>> RampProvider::make(const ProviderRequest& request, ReliefKind kind) {
  const bool isSlope = kind == ReliefKind::Slope;
  glm::dvec2 values = isSlope ? glm::dvec2(0.0, 60.0) : glm::dvec2(0.0, 8000.0);
  if (const auto numbers = valueAt(request.table, "Range").numbers(2)) {
    values = {(*numbers)[0], (*numbers)[1]};
  }
  const std::string* text = valueAt(request.table, "ColorRamp").string();
  if (text != nullptr) {
    if (Result<void> checked = checkRamp(*text, placeOf(request, "ColorRamp")); !checked) {
      return tl::make_unexpected(std::move(checked.error()));
    }
  }
  auto provider = std::make_shared<RampProvider>(
      kind, text != nullptr ? *text : std::string(isSlope ? darkRamp : greyRamp), values);
  if (const std::string* file = valueAt(request.table, "ColorRampFile").string()) {
    provider->file_ = dataPath(*file, request.folder).text;
    provider->rampFile.put(*file);
    provider->add(provider->rampFile);
    provider->where_ = placeOf(request, "ColorRampFile");
  }
  return provider;
}

RampProvider::RampProvider(ReliefKind kind, std::string ramp, const glm::dvec2& values)
    : ReliefProvider(kind),
      colourRamp({"ColorRamp", "Color ramp", "Values and their colours, as gdaldem color-relief takes them"},
                 std::move(ramp)),
      range({"Range", "Range", "What 0% and 100% mean in the ramp: metres, or degrees of slope"}, values) {
  colourRamp.onChange([this] {
    if (!isTaking_) {
      isRampSet_ = true;
      rampFile.put({});
    }
  });
  add(colourRamp);
  add(range);
}

Result<void> RampProvider::check() const {
  return file_ ? checkData({DataPath::Kind::File, *file_}, where_) : Result<void>();
}

Result<void> RampProvider::openData() {
  if (!file_) {
    return {};
  }
  return check()
      .and_then([this] {
        return readTextFile(*file_, longestRampFile, where_, "name a text file as gdaldem color-relief takes it");
      })
      .and_then([this](std::string text) {
        fileText_ = std::move(text);
        return checkRamp(fileText_, where_ + ": " + *file_);
      });
}

void RampProvider::takeOpened() {
  if (file_ && !isRampSet_) {
    isTaking_ = true;
    colourRamp.put(fileText_);
    isTaking_ = false;
  }
}

void RampProvider::restyle() {
  style().problem.clear();
  if (file_ && state() != State::Ready && !isRampSet_) {
    return;
  }
  Result<ColourRamp> ramp = readColourRamp(colourRamp.get(), range.get());
  if (ramp) {
    style().ramp = std::make_shared<const ColourRamp>(std::move(*ramp));
    return;
  }
  style().problem = ramp.error().message();
  log::warning("{}: {}; the ramp stays as it is", colourRamp.uri(), style().problem);
}

const Schema& HillshadeProvider::schema() {
  static const Schema fields(
      {numberField("Azimuth", "where the light comes from, degrees clockwise from north", azimuthRange),
       numberField("Altitude", "the light's angle above the horizon, degrees", altitudeRange),
       numberField("ZFactor", "heights are multiplied by it", zFactorRange)});
  return fields;
}

Result<std::shared_ptr<TileProvider>> HillshadeProvider::make(const ProviderRequest& request) {
  auto provider = std::make_shared<HillshadeProvider>();
  take(request.table, "Azimuth", provider->azimuth);
  take(request.table, "Altitude", provider->altitude);
  take(request.table, "ZFactor", provider->zFactor);
  return provider;
}

HillshadeProvider::HillshadeProvider()
    : ReliefProvider(ReliefKind::Hillshade),
      azimuth({"Azimuth", "Azimuth", "Where the light comes from, degrees clockwise from north"}, 315.0, azimuthRange),
      altitude({"Altitude", "Altitude", "The light's angle above the horizon, degrees"}, 45.0, altitudeRange),
      zFactor({"ZFactor", "Z factor", "Heights are multiplied by it"}, 1.0, zFactorRange) {
  add(azimuth);
  add(altitude);
  add(zFactor);
}

void HillshadeProvider::restyle() {
  const double around = azimuth.get() * degree;
  const double up = altitude.get() * degree;
  style().parameters = glm::vec4(
      glm::dvec4(std::sin(around) * std::cos(up), std::cos(around) * std::cos(up), std::sin(up), zFactor.get()));
}

const Schema& IsolinesProvider::schema() {
  static const Schema fields({numberField("Interval", "metres from one line to the next; one is at 0", intervalRange),
                              numberField("LineWidth", "pixels of a tile, which has 512", widthRange),
                              {"LineColor", Schema::Type::Vector3, "red, green and blue of the lines", false, 0.0, 1.0},
                              numberField("LineOpacity", "0 is invisible, 1 opaque", unitRange)});
  return fields;
}

Result<std::shared_ptr<TileProvider>> IsolinesProvider::make(const ProviderRequest& request) {
  auto provider = std::make_shared<IsolinesProvider>();
  take(request.table, "Interval", provider->interval);
  take(request.table, "LineWidth", provider->lineWidth);
  take(request.table, "LineOpacity", provider->lineOpacity);
  if (const auto colour = valueAt(request.table, "LineColor").numbers(3)) {
    provider->lineColour.put({(*colour)[0], (*colour)[1], (*colour)[2]});
  }
  return provider;
}

IsolinesProvider::IsolinesProvider()
    : ReliefProvider(ReliefKind::Isolines),
      interval({"Interval", "Interval", "Metres from one line to the next; one is at 0"}, 100.0, intervalRange),
      lineWidth({"LineWidth", "Line width", "Pixels of a tile, which has 512"}, 1.5, widthRange),
      lineColour({"LineColor", "Line color", "Red, green and blue of the lines"}, glm::dvec3(0.0), unitRange),
      lineOpacity({"LineOpacity", "Line opacity", "0 is invisible, 1 opaque"}, 1.0, unitRange) {
  add(interval);
  add(lineWidth);
  add(lineColour);
  add(lineOpacity);
}

void IsolinesProvider::restyle() {
  style().parameters = glm::vec4(glm::dvec4(interval.get(), lineWidth.get(), lineOpacity.get(), 0.0));
  style().colour = lineColour.get();
}

}  // namespace meridian::globebrowsing
