#include "globebrowsing/layers/layer.h"

#include <algorithm>
#include <utility>

#include "globebrowsing/providers/layer_paths.h"
#include "globebrowsing/providers/path_tokens.h"
#include "globebrowsing/streaming/tile_streamer.h"
#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

/// Whether tiles wait for their server need not be known sooner.
constexpr int framesBetweenLooks = 30;

std::string_view stateName(TileProvider::State state) {
  switch (state) {
    case TileProvider::State::NotOpened:
      return "not opened";
    case TileProvider::State::Opening:
      return "opening";
    case TileProvider::State::Ready:
      return "ready";
    case TileProvider::State::Failed:
      return "failed";
  }
  return "failed";
}

Sampling samplingOf(TileProvider& provider) {
  if (provider.hasTiles()) {
    return Sampling::Tile;
  }
  const ReliefStyle* relief = provider.relief();
  if (relief == nullptr) {
    return Sampling::SolidColor;
  }
  switch (relief->kind) {
    case ReliefKind::ColorRelief:
      return Sampling::ColorRelief;
    case ReliefKind::Hillshade:
      return Sampling::Hillshade;
    case ReliefKind::Slope:
      return Sampling::Slope;
    case ReliefKind::Isolines:
      return Sampling::Isolines;
  }
  return Sampling::SolidColor;
}

}  // namespace

Layer::Layer(LayerDescription description, LayerGroupId group, const LayerServices& services,
             std::function<void(Layer&, Change)> changed)
    : PropertyOwner(description.identifier, description.name, description.description),
      type({"Type", "Type", "Where the layer's data come from", true}, layerTypeNames(),
           static_cast<int>(description.type)),
      enabled({"Enabled", "Enabled", "Whether the layer is shown"}, description.enabled),
      opacity({"Opacity", "Opacity", "0 is invisible, 1 opaque"}, description.opacity, opacityRange),
      fade({"Fade", "Fade", "Multiplies Opacity; what scripts use to fade"}, 1.0, opacityRange),
      blendMode({"BlendMode", "Blend mode", "How the layer is put onto those below"}, blendModeNames(),
                static_cast<int>(description.blendMode)),
      guiDescription({"GuiDescription", "Description", "What the layer shows", true}, description.description),
      attribution({"Attribution", "Attribution", "Whom the layer's data are to be credited to", true},
                  description.attribution),
      colour({"Color", "Color", "Of a SolidColor layer"}, description.colour, {0.0, 1.0}),
      gamma({"Gamma", "Gamma", "Exponent of a value's magnitude"}, description.settings.gamma, gammaRange),
      multiplier({"Multiplier", "Multiplier", "Factor, after the exponent"}, description.settings.multiplier,
                 multiplierRange),
      offset({"Offset", "Offset", "Added at last"}, description.settings.offset, offsetRange),
      adjustmentType({"Type", "Type", "Which adjustment"}, adjustmentNames(), static_cast<int>(description.adjustment)),
      chromaKeyColour({"ChromaKeyColor", "Chroma key color", "The colour that becomes transparent"},
                      description.chromaKeyColour, {0.0, 1.0}),
      chromaKeyTolerance({"ChromaKeyTolerance", "Chroma key tolerance", "How far from it colours still do"},
                         description.chromaKeyTolerance, {0.0, 1.0}),
      group_(group),
      zIndex_(description.zIndex.value_or(1)),
      hadZIndex_(description.zIndex.has_value()),
      sampling_(samplingOf(*description.provider)),
      request_(std::move(description.request)),
      data_(request_, description.type, [this] { wantsRestart_ = true; }),
      provider_(std::move(description.provider)),
      services_(services),
      player_(services.workers, services.streamer),
      changed_(std::move(changed)),
      hasOwnAttribution_(!attribution.get().empty()) {
  addProperties();
  connectProperties();
  attachProvider();
}

Layer::~Layer() {
  // A worker that still opens the provider may be the last to hold it.
  detachProvider();
}

void Layer::detachProvider() {
  PropertyOwner* owner = provider_->properties();
  data_.detach(*this, owner);
  if (owner != nullptr) {
    removeChild(*owner);
  }
}

void Layer::attachProvider() {
  if (PropertyOwner* owner = provider_->properties()) {
    addChild(*owner);
    if (isRelief(sampling_)) {
      for (Property* property : owner->properties()) {
        property->onChange([this] { changed_(*this, Change::Settings); });
      }
    }
  }
  data_.attach(*this, provider_->properties());
  step_ = provider_->steps() != nullptr
              ? nullptr
              : std::make_shared<const LayerStep>(provider_, services_.streamer, provider_.get());
}

void Layer::addProperties() {
  for (Property* property :
       std::initializer_list<Property*>{&type, &enabled, &opacity, &fade, &blendMode, &reset, &remove, &guiDescription,
                                        &attribution, &status, &lastError}) {
    addProperty(*property);
  }
  if (sampling_ == Sampling::SolidColor) {
    addProperty(colour);
  }
  for (Property* property : std::initializer_list<Property*>{&gamma, &multiplier, &offset, &setDefault}) {
    settingsOwner.addProperty(*property);
  }
  addChild(settingsOwner);
  for (Property* property : std::initializer_list<Property*>{&adjustmentType, &chromaKeyColour, &chromaKeyTolerance}) {
    adjustmentOwner.addProperty(*property);
  }
  addChild(adjustmentOwner);
}

void Layer::connectProperties() {
  const auto tell = [this](Change change) {
    return [this, change] {
      if (!quiet_) {
        changed_(*this, change);
      }
    };
  };
  for (Property* property : std::initializer_list<Property*>{&enabled, &blendMode, &adjustmentType}) {
    property->onChange(tell(Change::Structure));
  }
  for (Property* property : std::initializer_list<Property*>{&opacity, &fade}) {
    property->onChange(tell(Change::Opacity));
  }
  for (Property* property :
       std::initializer_list<Property*>{&colour, &gamma, &multiplier, &offset, &chromaKeyColour, &chromaKeyTolerance}) {
    property->onChange(tell(Change::Settings));
  }
  setDefault.onChange([this] {
    const LayerSettings before = settings();
    quiet_ = true;
    gamma.put(1.0);
    multiplier.put(1.0);
    offset.put(0.0);
    quiet_ = false;
    if (settings() != before) {
      changed_(*this, Change::Settings);
    }
  });
  reset.onChange([this] { restart(request_); });
  remove.onChange([this] { wantsRemoval_ = true; });
}

Value Layer::table() const {
  Table table = *data_.applied(request_.table).table();
  const auto keep = [&table](const Property& property) { table.fields[property.identifier()] = property.value(); };
  if (hadZIndex_ || wasMoved_) {
    table.fields["ZIndex"] = zIndex_;
  }
  keep(enabled);
  keep(opacity);
  table.fields["BlendMode"] = blendMode.word();
  table.fields["Settings"] =
      Table{{}, {{"Gamma", gamma.get()}, {"Multiplier", multiplier.get()}, {"Offset", offset.get()}}};
  table.fields["Adjustment"] = Table{{},
                                     {{"Type", adjustmentType.word()},
                                      {"ChromaKeyColor", Value(chromaKeyColour.get())},
                                      {"ChromaKeyTolerance", chromaKeyTolerance.get()}}};
  if (sampling_ == Sampling::SolidColor) {
    keep(colour);
  }
  if (PropertyOwner* owner = provider_->properties()) {
    const auto& keys = providerSchema(static_cast<LayerType>(type.get())).fields();
    for (const Property* property : owner->properties()) {
      const bool isKey = std::any_of(keys.begin(), keys.end(),
                                     [&](const Schema::Field& field) { return field.key == property->identifier(); });
      if (isKey && !property->isReadOnly()) {
        keep(*property);
      } else if (isKey && property->value() == Value("")) {
        table.fields.erase(property->identifier());  // what was set since holds in its place
      }
    }
  }
  return withWholePaths(withTokensReplaced(table, services_.tokenFolder), request_.folder);
}

bool Layer::isReady() const {
  return isEnabled() && sampling_ == Sampling::Tile && step_ != nullptr &&
         step_->tiles()->state() == TileProvider::State::Ready;
}

bool Layer::isOpening() const {
  // What a worker has published since the last update is not in what was made after it.
  return sampling_ != Sampling::SolidColor &&
         (seenState_ == TileProvider::State::NotOpened || seenState_ == TileProvider::State::Opening ||
          (seenState_ == TileProvider::State::Ready && step_ == nullptr && player_.awaits()));
}

void Layer::restart(ProviderRequest request) {
  request.table = withTokensReplaced(request.table, services_.tokenFolder);
  Result<std::shared_ptr<TileProvider>> provider = makeProvider(request);
  if (!provider) {
    lastError.put(provider.error().message());
    return;
  }
  detachProvider();
  player_.clear();
  request_ = std::move(request);
  type.put(static_cast<int>(*layerTypeOf(request_)));  // a path may name what follows time, or no longer
  provider_ = std::move(*provider);
  attachProvider();
  seenState_ = TileProvider::State::NotOpened;
  seenError_ = nullptr;
  seenFailure_.clear();
  status.put(std::string(stateName(seenState_)));
  lastError.put({});
  changed_(*this, Change::Settings);
}

void Layer::retryFailed() {
  wantsRestart_ = wantsRestart_ || provider_->state() == TileProvider::State::Failed ||
                  (step_ != nullptr && step_->hasFailed()) || player_.hasFailed();
}

void Layer::update(const Time& now) {
  if (std::exchange(wantsRestart_, false)) {
    ProviderRequest request = request_;
    request.table = data_.applied(request_.table);
    restart(std::move(request));
  }
  if (isEnabled() && services_.workers != nullptr && provider_->state() == TileProvider::State::NotOpened) {
    TileProvider::openOn(*services_.workers, provider_);
  }
  updateStatus();
  updateRelief();
  if (provider_->steps() != nullptr && provider_->state() == TileProvider::State::Ready) {
    play(now);
  }
  updateAttribution();
}

void Layer::updateAttribution() {
  const std::string_view found =
      hasOwnAttribution_ || step_ == nullptr ? attribution.get() : step_->tiles()->attribution();
  if (found != attribution.get()) {
    attribution.put(std::string(found));
  }
}

void Layer::play(const Time& now) {
  if (!isEnabled()) {
    player_.rest();
    return;
  }
  player_.update(*provider_, now);
  if (player_.current() == step_) {
    return;
  }
  const bool isFirst = step_ == nullptr;
  step_ = player_.current();
  lastError.put(player_.error().empty() ? seenFailure_ : player_.error());
  // Colours of another step are composed beside those that are drawn, and exchanged; heights are composed anew.
  if (isFirst || group_ == LayerGroupId::HeightLayers) {
    changed_(*this, Change::Settings);
  }
}

void Layer::updateStatus() {
  if (const TileProvider::State state = provider_->state(); state != seenState_) {
    seenState_ = state;
    status.put(std::string(stateName(state)));
    if (const std::optional<Error> error = provider_->error()) {
      lastError.put(error->message());
    }
    if (state == TileProvider::State::Ready || state == TileProvider::State::Failed) {
      changed_(*this, Change::Settings);
    }
  }
  const Error* tileError = services_.streamer != nullptr ? services_.streamer->lastError(stream()) : nullptr;
  if (tileError != seenError_) {
    seenError_ = tileError;
    lastError.put(tileError != nullptr ? tileError->message() : std::string());
  }
  if (--framesUntilLook_ < 0) {
    framesUntilLook_ = framesBetweenLooks;
    noteWaiting();
  }
}

void Layer::updateRelief() {
  // Looked at every frame, so that the ramp of a file that has been opened becomes the property's.
  const ReliefStyle* style = relief();
  if (style != nullptr && style->problem != seenProblem_) {
    seenProblem_ = style->problem;
    lastError.put(seenProblem_);
  }
}

void Layer::noteWaiting() {
  const std::optional<Error> failure = (step_ != nullptr ? step_->tiles() : provider_)->lastFailure();
  std::string text = failure ? failure->message() : std::string();
  if (text == seenFailure_) {
    return;
  }
  if (seenFailure_.empty()) {
    log::warning("{} waits: {}", uri(), text);
  }
  seenFailure_ = std::move(text);
  lastError.put(seenFailure_.empty() && seenError_ != nullptr ? seenError_->message() : seenFailure_);
}

}  // namespace meridian::globebrowsing
