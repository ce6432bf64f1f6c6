#include <map>

#include "data_check.h"
#include "paloc/core/text.h"
#include "sentence_parts.h"

namespace paloc {
namespace {

constexpr std::size_t kMostReasons = 20;  // apart; readers put figures into theirs

class RefusedCheck : public DataCheck {
 public:
  explicit RefusedCheck(const CheckedStream& stream) : stream_(stream) {}

  void addStamp(TimeNs) override { ++seen_; }
  void addRefused(TimeNs t_ns, const std::string& reason) override {
    const bool known = reasons_.contains(reason) || reasons_.size() < kMostReasons;
    Count& count = reasons_[known ? reason : "other reasons"];
    if (count.times++ == 0) count.first_ns = t_ns;
  }
  void addScan(const LidarFrame& frame) override {
    if (frame.points_lidar.empty()) addRefused(frame.stamp_ns, "without a valid point");
  }

  void report(Findings& findings) const override {
    for (const auto& [reason, count] : reasons_) {
      const bool not_finite = reason == "not finite";
      const bool all = count.times == seen_;
      Finding finding = stream_.finding(not_finite ? "non-finite" : "unreadable",
                                        all ? Severity::kError : Severity::kWarning);
      finding.value = static_cast<double>(count.times);
      finding.t_ns = count.first_ns;
      finding.sentence =
          text(count.times, " of ", seen_, " observations of ", stream_.name(), " cannot be used (",
               reason,
               not_finite ? "): look at the driver, which writes NaN where it has no value; "
                            "they count as if they were not there"
                          : ")");
      findings.push_back(finding);
    }
  }

 private:
  struct Count {
    std::uint64_t times = 0;
    TimeNs first_ns = 0;
  };

  CheckedStream stream_;
  std::uint64_t seen_ = 0;
  std::map<std::string, Count> reasons_;
};

}  // namespace

DataCheckPtr makeRefusedCheck(const CheckedStream& stream) {
  return std::make_unique<RefusedCheck>(stream);
}

}  // namespace paloc
