#pragma once

#include "paloc/core/types.h"

namespace paloc {

inline Vec3 toVec(const Point3f& p) {
  return {static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z)};
}

inline Eigen::Vector3f toVec3f(const Point3f& p) { return {p.x, p.y, p.z}; }

inline Point3f toPoint(const Vec3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

}  // namespace paloc
