#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>

#include "paloc/config/config.h"
#include "paloc/core/errors.h"
#include "value.h"

namespace paloc {
namespace {

constexpr std::size_t kMaxBytes = 1 << 20;

bool isSection(std::string_view path) {
  const auto& all = allSettings();
  return std::any_of(all.begin(), all.end(), [&](const Setting& s) {
    return s.key.size() > path.size() && s.key.starts_with(path) && s.key[path.size()] == '.';
  });
}

/// Walks one YAML document and writes its values into a configuration.
class Reader {
 public:
  Reader(Config& config, std::string name) : config_(config), name_(std::move(name)) {}

  void readDocument(const YAML::Node& root) {
    if (root.IsNull()) return;
    if (!root.IsMap()) failAt(root.Mark(), "", "expects 'key: value' lines");
    readMap(root, "");
    const Contradiction wrong = findContradiction(config_);
    if (wrong.key.empty()) return;
    const auto line = lines_.find(wrong.key);
    fail(line == lines_.end() ? 0 : line->second, wrong.key, wrong.sentence);
  }

  [[noreturn]] void failAt(const YAML::Mark& mark, const std::string& key,
                           const std::string& sentence) const {
    fail(mark.is_null() ? 0 : mark.line + 1, key, sentence);
  }

 private:
  [[noreturn]] void fail(int line, const std::string& key, const std::string& sentence) const {
    std::string text = name_ + ":";
    if (line > 0) text += std::to_string(line) + ":";
    if (!key.empty()) text += " " + key + ":";
    throw ConfigError(text + " " + sentence);
  }

  void readMap(const YAML::Node& map, const std::string& path) {
    for (const auto& entry : map) {
      if (!entry.first.IsScalar()) failAt(entry.first.Mark(), path, "a key must be a name");
      const std::string key = (path.empty() ? "" : path + ".") + entry.first.Scalar();
      readEntry(key, entry.first.Mark(), entry.second);
    }
  }

  void readEntry(const std::string& key, const YAML::Mark& mark, const YAML::Node& value) {
    const auto [first, is_new] = lines_.emplace(key, mark.line + 1);
    if (!is_new) failAt(mark, key, "given twice, first in line " + std::to_string(first->second));
    if (isSection(key)) {
      if (value.IsMap()) return readMap(value, key);
      if (value.IsNull()) return;
      failAt(value.Mark(), key, "is a section: its keys go below it");
    }
    const Setting* setting = findSetting(key);
    if (setting == nullptr) failAt(mark, key, unknownKeySentence(key));
    if (value.IsNull()) failAt(mark, key, "has no value");
    if (!value.IsScalar()) failAt(value.Mark(), key, "expects one value, not a list or a map");
    readValue(*setting, value);
  }

  void readValue(const Setting& setting, const YAML::Node& value) {
    // yaml-cpp's tag of a plain scalar is "?", of a quoted one "!".
    const bool is_text = std::holds_alternative<std::string>(setting.get(config_));
    if (value.Tag() != "?" && value.Tag() != "!") {
      failAt(value.Mark(), setting.key, "takes no tag, as in '" + value.Tag() + "'");
    }
    try {
      if (value.Tag() == "!" && !is_text) {
        throw ConfigError("expects a " + typeName(setting) + " without quotes");
      }
      setting.set(config_, parseValue(setting, value.Scalar()));
    } catch (const ConfigError& e) {
      failAt(value.Mark(), setting.key, e.what());
    }
  }

  Config& config_;
  std::string name_;
  std::map<std::string, int> lines_;  ///< line of each key seen
};

void overlayText(Config& config, std::string_view text, const std::string& name) {
  Config result = config;
  Reader reader(result, name);
  if (text.find('\0') != std::string_view::npos) throw ConfigError(name + ": is not a text file");
  try {
    const auto documents = YAML::LoadAll(std::string(text));
    if (documents.size() > 1) {
      reader.failAt(documents[1].Mark(), "", "holds a second document after '---'");
    }
    if (!documents.empty()) reader.readDocument(documents[0]);
  } catch (const YAML::Exception& e) {
    reader.failAt(e.mark, "", "is not YAML: " + e.msg);
  }
  config = std::move(result);
}

std::string readText(const std::filesystem::path& file) {
  std::error_code error;
  const auto status = std::filesystem::status(file, error);
  if (!std::filesystem::exists(status)) throw ConfigError(file.string() + ": no such file");
  if (std::filesystem::is_directory(status)) {
    throw ConfigError(file.string() + ": is a folder, not a configuration file");
  }
  std::ifstream in(file, std::ios::binary);
  std::string text(kMaxBytes + 1, '\0');
  in.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (in.bad() || (in.fail() && !in.eof())) throw ConfigError(file.string() + ": cannot be read");
  text.resize(static_cast<std::size_t>(in.gcount()));
  if (text.size() > kMaxBytes) {
    throw ConfigError(file.string() + ": is larger than 1 MiB: not a configuration");
  }
  return text;
}

}  // namespace

Config parseConfig(std::string_view text, const std::string& name) {
  Config config;
  overlayText(config, text, name);
  return config;
}

Config loadConfig(const std::filesystem::path& file) {
  Config config;
  overlayConfig(config, file);
  return config;
}

void overlayConfig(Config& config, const std::filesystem::path& file) {
  overlayText(config, readText(file), file.string());
}

}  // namespace paloc
