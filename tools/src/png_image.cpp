#include "paloc/tools/png_image.h"

#include <zlib.h>

#include <stdexcept>

namespace paloc {
namespace {

void appendBigEndian(std::string& bytes, std::uint32_t value) {
  for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>((value >> shift) & 0xFF);
}

void appendChunk(std::string& png, const std::string& type, const std::string& data) {
  appendBigEndian(png, static_cast<std::uint32_t>(data.size()));
  const std::string body = type + data;
  png += body;
  const auto* begin = reinterpret_cast<const Bytef*>(body.data());
  appendBigEndian(png, static_cast<std::uint32_t>(crc32(0, begin, static_cast<uInt>(body.size()))));
}

std::string compressed(const std::string& raw) {
  uLongf size = compressBound(raw.size());
  std::string bytes(size, '\0');
  const int code = compress2(reinterpret_cast<Bytef*>(bytes.data()), &size,
                             reinterpret_cast<const Bytef*>(raw.data()), raw.size(), 6);
  if (code != Z_OK) throw std::runtime_error("zlib could not compress an image");
  bytes.resize(size);
  return bytes;
}

std::string header(const OpacityImage& image) {
  std::string data;
  appendBigEndian(data, static_cast<std::uint32_t>(image.width));
  appendBigEndian(data, static_cast<std::uint32_t>(image.height));
  // 8 bits a pixel, colour type 3 (palette), deflate, adaptive filtering, not interlaced.
  return data + std::string("\x08\x03\x00\x00\x00", 5);
}

}  // namespace

std::string encodePng(const OpacityImage& image) {
  std::string palette, transparency;
  for (int i = 0; i < 256; ++i) {
    for (const std::uint8_t c : {image.red, image.green, image.blue}) {
      palette += static_cast<char>(c);
    }
    transparency += static_cast<char>(i);
  }
  std::string rows;
  for (std::size_t y = 0; y < image.height; ++y) {
    rows += '\0';  // each row begins with its filter: none, as fits a palette
    const auto begin = image.opacity.begin() + static_cast<std::ptrdiff_t>(y * image.width);
    rows.append(begin, begin + static_cast<std::ptrdiff_t>(image.width));
  }
  std::string png("\x89PNG\r\n\x1a\n", 8);
  appendChunk(png, "IHDR", header(image));
  appendChunk(png, "PLTE", palette);
  appendChunk(png, "tRNS", transparency);
  appendChunk(png, "IDAT", compressed(rows));
  appendChunk(png, "IEND", "");
  return png;
}

std::string base64(const std::string& bytes) {
  static constexpr char kAlphabet[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = (group << 8) | (i + k < bytes.size() ? static_cast<std::uint8_t>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const bool padding = i + k > bytes.size();
      text += padding ? '=' : kAlphabet[(group >> (18 - 6 * k)) & 63];
    }
  }
  return text;
}

}  // namespace paloc
