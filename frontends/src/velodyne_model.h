#pragma once

#include <array>
#include <cstdint>
#include <string_view>

/// What the manuals of the Velodyne sensors say about their beams (VLP-16 user manual 63-9243,
/// section 9.3 and appendix A; HDL-32E user manual 63-9113, chapter on firing sequence).
namespace paloc::velodyne {

struct Model {
  std::string_view name;
  int lasers = 0;
  int firings_per_block = 0;   ///< how often all lasers fire in one data block of 32 returns
  std::int64_t firing_ns = 0;  ///< from the first laser to the first laser of the next firing
  std::int64_t laser_ns = 0;   ///< from a laser to the next within a firing
  std::array<double, 32> elevation_deg{};  ///< by laser, in the order of firing
};

inline constexpr Model kVlp16 = {
    "VLP-16", 16, 2, 55'296, 2'304, {-15, 1, -13, 3, -11, 5, -9, 7, -7, 9, -5, 11, -3, 13, -1, 15}};

inline constexpr Model kHdl32 = {
    "HDL-32E", 32, 1, 46'080, 1'152, {-30.67, -9.33, -29.33, -8.00, -28.00, -6.67, -26.67, -5.33,
                                      -25.33, -4.00, -24.00, -2.67, -22.67, -1.33, -21.33, 0.00,
                                      -20.00, 1.33,  -18.67, 2.67,  -17.33, 4.00,  -16.00, 5.33,
                                      -14.67, 6.67,  -13.33, 8.00,  -12.00, 9.33,  -10.67, 10.67}};

}  // namespace paloc::velodyne
