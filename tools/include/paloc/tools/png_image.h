#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace paloc {

/// A picture of one colour whose opacity varies: 0 is clear, 255 opaque. Rows from top to bottom.
struct OpacityImage {
  std::size_t width = 0;
  std::size_t height = 0;
  std::vector<std::uint8_t> opacity;  ///< width * height
  std::uint8_t red = 0, green = 0, blue = 0;
};

/// The image as a PNG file's bytes (8-bit palette with transparency, W3C "Portable Network
/// Graphics", second edition). Sides must be positive.
std::string encodePng(const OpacityImage& image);

/// RFC 4648, with padding.
std::string base64(const std::string& bytes);

}  // namespace paloc
