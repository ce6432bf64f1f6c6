#include "paloc/tools/imu_csv.h"

#include <cmath>

#include "csv_rows.h"
#include "paloc/core/errors.h"
#include "paloc/core/text.h"

namespace paloc {

ImuCsv readImuCsv(const std::filesystem::path& file) {
  CsvRows rows(file, {"t_s", "ax_mps2", "ay_mps2", "az_mps2", "wx_radps", "wy_radps", "wz_radps"});
  ImuCsv result;
  for (const std::string& name : rows.others()) {
    result.other_columns += (result.other_columns.empty() ? "" : ", ") + name;
  }
  while (rows.next()) {
    ImuSample sample;
    sample.t_ns = rows.time(0);
    sample.acc_body = Vec3(rows.number(1), rows.number(2), rows.number(3));
    sample.omega_body = Vec3(rows.number(4), rows.number(5), rows.number(6));
    if (sample.acc_body.allFinite() && sample.omega_body.allFinite()) {
      result.samples.push_back(sample);
    } else {
      ++result.nonfinite;
    }
  }
  if (result.samples.empty()) throw IoError(text(file.string(), ": holds no sample"));
  return result;
}

}  // namespace paloc
