#pragma once

namespace paloc {

/// Port: is told when a stage of the work begins and ends, so that the caller can measure it. The
/// estimator itself never reads a clock.
class StageTimer {
 public:
  virtual ~StageTimer() = default;
  virtual void begin(const char* stage) = 0;
  virtual void end(const char* stage) = 0;
};

/// A stage that ends with the scope; `timer` may be null.
class StageScope {
 public:
  StageScope(StageTimer* timer, const char* stage) : timer_(timer), stage_(stage) {
    if (timer_) timer_->begin(stage_);
  }
  ~StageScope() {
    if (timer_) timer_->end(stage_);
  }
  StageScope(const StageScope&) = delete;
  StageScope& operator=(const StageScope&) = delete;

 private:
  StageTimer* timer_;
  const char* stage_;
};

}  // namespace paloc
