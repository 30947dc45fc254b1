#pragma once

#include <chrono>

namespace meridian::graphics {

/// How much of a frame's milliseconds for uploads is left, by the steady clock. Whoever uploads asks `left()` before
/// each piece, so a frame overruns by at most one piece. Time between pauses counts only while a Span lives.
class UploadBudget {
 public:
  /// Starts a frame. 0 milliseconds or less: nothing is left at once.
  void begin(double milliseconds) {
    budget_ = Milliseconds(milliseconds);
    spent_ = Milliseconds(0);
    open_ = 0;
  }

  /// Counts the time of a piece of uploading; spans may nest, the outermost counts.
  class Span {
   public:
    explicit Span(UploadBudget& budget) : budget_(budget) {
      if (budget_.open_++ == 0) {
        budget_.start_ = Clock::now();
      }
    }
    ~Span() {
      if (--budget_.open_ == 0) {
        budget_.spent_ += Clock::now() - budget_.start_;
      }
    }
    Span(const Span&) = delete;
    Span& operator=(const Span&) = delete;

   private:
    UploadBudget& budget_;
  };

  [[nodiscard]] bool left() const { return spent() < budget_.count(); }
  /// Milliseconds spent in this frame, the open span included: what Statistics::Frame::upload gets.
  [[nodiscard]] double spent() const {
    const Milliseconds running = open_ > 0 ? Milliseconds(Clock::now() - start_) : Milliseconds(0);
    return (spent_ + running).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  using Milliseconds = std::chrono::duration<double, std::milli>;
  Milliseconds budget_{0};
  Milliseconds spent_{0};
  Clock::time_point start_{};
  int open_ = 0;
};

}  // namespace meridian::graphics
