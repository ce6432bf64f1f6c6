#pragma once

#include <cstdint>
#include <random>

namespace paloc::synth {

/// What a stream of random numbers is for: two purposes never share numbers.
enum class RandomPurpose : std::uint64_t {
  kWalk = 1,
  kScan,
  kImu,
  kOdometry,
  kSurvey,
  kSurfaceBias,
  kRooms,
  kPose,
  kStart,
  kMissing,
  kSurveyLots
};

/// A stream of random numbers of its own for (seed, purpose, index), so that work may be done in
/// any order and on any number of threads with the same numbers.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, RandomPurpose purpose, std::uint64_t index)
      : engine_(mix(mix(mix(seed) + static_cast<std::uint64_t>(purpose)) + index)) {}

  double normal() { return normal_(engine_); }    ///< mean 0, variance 1
  double uniform() { return uniform_(engine_); }  ///< in [0, 1)
  double sign() { return uniform() < 0.5 ? -1.0 : 1.0; }

 private:
  /// The finalizer of SplitMix64 (Steele, Lea, Flood 2014): neighbouring numbers come out
  /// unrelated.
  static std::uint64_t mix(std::uint64_t z) {
    z += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
  std::uniform_real_distribution<double> uniform_;
};

}  // namespace paloc::synth
