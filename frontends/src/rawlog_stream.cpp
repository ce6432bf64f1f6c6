#include "paloc/frontends/rawlog_stream.h"

#include <mrpt/maps/registerAllClasses.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/obs/CSensoryFrame.h>

#include <deque>
#include <new>

#include "gz_stream.h"
#include "paloc/core/text.h"
#include "paloc/frontends/CObservationLidarScan.h"

namespace paloc {
namespace {

// The part of an MRPT exception's text that means something: it comes with a call stack.
std::string firstMeaning(std::string_view what) {
  constexpr std::string_view kMessage = "Message:";
  if (const auto at = what.find(kMessage); at != std::string_view::npos) {
    what.remove_prefix(at + kMessage.size());
  }
  const auto begin = what.find_first_not_of(" \t\n");
  if (begin == std::string_view::npos) return "unknown error";
  what.remove_prefix(begin);
  return std::string(what.substr(0, what.find('\n')));
}

std::string inOurWords(std::string_view what) {
  const auto has = [what](std::string_view part) { return what.find(part) != what.npos; };
  if (has("which is not registered")) {
    const auto begin = what.find('\'') + 1;
    const auto name = what.substr(begin, what.find('\'', begin) - begin);
    return text("class '", name,
                "' is not known here; if a library brings it, name that with --plugin LIB.so");
  }
  if (has("Cannot read requested number of bytes")) return "the file ends inside it";
  if (has("Class name has more than") || has("parsing old streaming header") || has("Non-ASCII") ||
      has("end-flag")) {
    return "these bytes are no rawlog object (damaged, or no rawlog at all)";
  }
  return firstMeaning(what);
}

}  // namespace

struct RawlogStream::Impl {
  explicit Impl(const std::filesystem::path& path) : file(path.string()), archive(path) {}

  void readObject();
  void queue(const mrpt::serialization::CSerializable::Ptr& object);
  void damaged(const std::string& sentence) {
    end = End::kDamaged;
    error = text(file, ": object ", objects + 1, ": ", sentence);
  }

  std::string file;
  GzReadArchive archive;
  std::deque<mrpt::obs::CObservation::Ptr> pending;
  End end = End::kNone;
  std::string error;
  std::uint64_t objects = 0;
};

void RawlogStream::Impl::queue(const mrpt::serialization::CSerializable::Ptr& object) {
  using namespace mrpt::obs;
  if (auto observation = std::dynamic_pointer_cast<CObservation>(object)) {
    if (!std::dynamic_pointer_cast<CObservationComment>(observation))
      pending.push_back(observation);
  } else if (auto frame = std::dynamic_pointer_cast<CSensoryFrame>(object)) {
    for (const auto& observation_of_frame : *frame) pending.push_back(observation_of_frame);
  } else if (auto whole = std::dynamic_pointer_cast<CRawlog>(object)) {  // old files are one object
    for (const auto& entry : *whole) queue(entry);
  }
}

void RawlogStream::Impl::readObject() {
  if (archive.atEnd()) {
    const std::string damage = archive.damage();
    end = End::kClean;
    if (!damage.empty()) damaged(damage);
    return;
  }
  try {
    queue(archive.ReadObject());
    ++objects;
  } catch (const std::bad_alloc&) {
    damaged("a length in it is absurd");
  } catch (const std::exception& e) {
    const std::string damage = archive.damage();
    damaged(damage.empty() ? inOurWords(e.what()) : damage);
  }
}

RawlogStream::RawlogStream(const std::filesystem::path& file) {
  // Said aloud, since the linker leaves out a library of which nothing is called.
  mrpt::maps::registerAllClasses_mrpt_maps();
  mrpt::rtti::registerClass(CLASS_ID(obs::CObservationLidarScan));
  impl_ = std::make_unique<Impl>(file);
}

RawlogStream::~RawlogStream() = default;

mrpt::obs::CObservation::Ptr RawlogStream::next() {
  while (impl_->pending.empty() && impl_->end == End::kNone) impl_->readObject();
  if (impl_->pending.empty()) return {};
  auto observation = std::move(impl_->pending.front());
  impl_->pending.pop_front();
  return observation;
}

RawlogStream::End RawlogStream::end() const { return impl_->end; }
const std::string& RawlogStream::error() const { return impl_->error; }
std::uint64_t RawlogStream::objectsRead() const { return impl_->objects; }
double RawlogStream::progress() const { return impl_->archive.progress(); }

}  // namespace paloc
