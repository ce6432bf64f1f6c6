#pragma once

#include <array>
#include <cstdint>

namespace paloc {

/// Quantiles of positive values from 1e-7 to 1e7, to half a percent, in memory that does not grow.
class LogHistogram {
 public:
  void add(double value);  ///< zero and less counts as the smallest
  std::uint64_t count() const { return count_; }
  /// The value that a share of `q` (0..1) lies below; 0 if there are none.
  double quantile(double q) const;
  std::uint64_t countAbove(double value) const;

  /// Calls tell(value, count) for each value that came, to half a percent, in order.
  template <typename Tell>
  void each(const Tell& tell) const {
    for (int bin = 0; bin < kBins; ++bin) {
      const std::uint64_t count = bins_[static_cast<std::size_t>(bin)];
      if (count > 0) tell(valueOf(bin), count);
    }
  }

 private:
  static constexpr int kBins = 3242;  // of 1 %: ln(1e14) / ln(1.01), and two for the ends
  static int binOf(double value);
  static double valueOf(int bin);

  std::array<std::uint64_t, kBins> bins_{};
  std::uint64_t count_ = 0;
};

}  // namespace paloc
