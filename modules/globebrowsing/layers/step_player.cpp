#include "globebrowsing/layers/step_player.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "host/api/log.h"

namespace meridian::globebrowsing {

namespace {

using State = TileProvider::State;

/// Seconds by which a time is surely in the step before.
constexpr double before = 1e-3;

/// Open, or never going to be.
bool isDone(const LayerStep& step) {
  const State state = step.tiles()->state();
  return state == State::Ready || state == State::Failed;
}

}  // namespace

void StepPlayer::update(const TileProvider& source, const Time& now) {
  ++frame_;
  noteMotion(now);
  const LayerStepPointer wanted = stepAt(source, now);
  awaits_ = wanted != nullptr && !isDone(*wanted);
  other_.reset();
  if (wanted != nullptr) {
    show(wanted);
    if (source.steps()->interpolates() && current_ == wanted) {
      mix(source, now);
    }
    lookAhead(source, now, wanted->when());
  }
  dropUnused();
}

void StepPlayer::noteMotion(const Time& now) {
  const double moved = last_ ? now - *last_ : 0.0;
  last_ = now;
  if (moved == 0.0) {
    rested_ = true;  // what is ahead stays ahead through a pause
    return;
  }
  // Frames are not all alike. After a rest only the same again is play: a film whose frames are waited for.
  const double mostUneven = rested_ ? 1.5 : 16.0;
  const double ratio = moved / moved_;
  plays_ = std::isfinite(ratio) && ratio > 1.0 / mostUneven && ratio < mostUneven;
  moved_ = moved;
  rested_ = false;
}

LayerStepPointer StepPlayer::stepAt(const TileProvider& source, const Time& time) {
  const TileStep when = source.steps()->at(time);
  auto found =
      std::find_if(kept_.begin(), kept_.end(), [&](const Kept& kept) { return kept.step->when().id == when.id; });
  if (found == kept_.end()) {
    Result<std::shared_ptr<TileProvider>> tiles = source.steps()->make(time);
    if (!tiles) {
      error_ = tiles.error().message();
      return nullptr;
    }
    kept_.push_back({std::make_shared<const LayerStep>(std::move(*tiles), streamer_, &source, when), frame_});
    found = kept_.end() - 1;
  }
  found->lastUsed = frame_;
  const auto opening = std::count_if(kept_.begin(), kept_.end(),
                                     [](const Kept& kept) { return kept.step->tiles()->state() == State::Opening; });
  if (workers_ != nullptr && static_cast<std::size_t>(opening) < mostOpening &&
      found->step->tiles()->state() == State::NotOpened) {
    TileProvider::openOn(*workers_, found->step->tiles(), false);
  }
  return found->step;
}

void StepPlayer::show(const LayerStepPointer& wanted) {
  LayerStepPointer shown = isDone(*wanted) ? wanted : current_;
  if (shown != wanted && current_ != nullptr && plays_) {
    // Of the steps on the way to the wanted one, the nearest to it that is open.
    const auto [from, to] = std::minmax(current_->when().begin, wanted->when().begin);
    double nearest = std::abs(wanted->when().begin - current_->when().begin);
    for (const Kept& kept : kept_) {
      const Time begin = kept.step->when().begin;
      const double distance = std::abs(wanted->when().begin - begin);
      if (isDone(*kept.step) && begin > from && begin < to && distance < nearest) {
        shown = kept.step;
        nearest = distance;
      }
    }
  }
  if (shown == current_) {
    return;
  }
  current_ = shown;
  const std::optional<Error> error = current_->tiles()->error();
  error_ = error ? error->message() : std::string();
  if (error && !told_) {
    told_ = true;
    log::error("{}; more of this layer's steps may be missing", error_);
  }
}

void StepPlayer::mix(const TileProvider& source, const Time& now) {
  const TileStep& shown = current_->when();
  const Time beyond = now < shown.instant ? shown.begin + -before : shown.end;
  if (current_->tiles()->state() != State::Ready || !std::isfinite(beyond.tdbSeconds())) {
    return;
  }
  const LayerStepPointer other = stepAt(source, beyond);
  if (other == nullptr || other == current_) {
    return;
  }
  const double weight = (now - shown.instant) / (other->when().instant - shown.instant);
  if (!(weight >= 0.0 && weight <= 1.0)) {
    return;  // not between them: a service's default, or a file that shows for longer than it should
  }
  awaits_ = awaits_ || !isDone(*other);
  if (other->tiles()->state() == State::Ready) {
    other_ = other;
    otherWeight_ = weight;
  }
}

void StepPlayer::lookAhead(const TileProvider& source, const Time& now, const TileStep& shown) {
  if (!plays_) {
    ahead_.clear();
    return;
  }
  ahead_.clear();
  TileStep last = shown;
  Time time = now;
  for (int i = 0; i < stepsAhead; ++i) {
    // The next step, or where time will be in the next frame if that is further.
    time = moved_ > 0.0 ? std::max(last.end, time + moved_) : std::min(last.begin + -before, time + moved_);
    if (!std::isfinite(time.tdbSeconds())) {
      return;
    }
    const LayerStepPointer step = stepAt(source, time);
    if (step == nullptr || step->when().id == last.id) {
      return;
    }
    last = step->when();
    if (step->tiles()->state() == State::Ready) {
      ahead_.push_back(step);
    }
  }
}

void StepPlayer::dropUnused() {
  while (kept_.size() > mostKept) {
    auto oldest = kept_.end();
    for (auto kept = kept_.begin(); kept != kept_.end(); ++kept) {
      // One that is being opened stays, or there could be any number of those.
      if (kept->lastUsed != frame_ && kept->step != current_ && kept->step->tiles()->state() != State::Opening &&
          (oldest == kept_.end() || kept->lastUsed < oldest->lastUsed)) {
        oldest = kept;
      }
    }
    if (oldest == kept_.end()) {
      return;
    }
    kept_.erase(oldest);
  }
}

void StepPlayer::rest() {
  std::erase_if(kept_, [this](const Kept& kept) {
    return kept.step != current_ && kept.step->tiles()->state() != State::Opening;
  });
  ahead_.clear();
  other_.reset();
  last_.reset();
  plays_ = false;
  awaits_ = false;
}

bool StepPlayer::hasFailed() const {
  return std::any_of(kept_.begin(), kept_.end(), [](const Kept& kept) { return kept.step->hasFailed(); });
}

void StepPlayer::clear() {
  kept_.clear();
  current_.reset();
  error_.clear();
  told_ = false;
  rest();
}

}  // namespace meridian::globebrowsing
