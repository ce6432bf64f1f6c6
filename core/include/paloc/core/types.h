#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace paloc {

// Fixed-size types that may cross a library border. Eigen aligns sizes that are multiples of 16
// bytes by what -march allows, so those are declared unaligned: their layout is the same for any
// compiler flag. A vector of three and a 3 x 3 matrix are never aligned by Eigen.
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
using Vec6 = Eigen::Matrix<double, 6, 1, Eigen::DontAlign>;
using Mat6 = Eigen::Matrix<double, 6, 6, Eigen::DontAlign>;
using Quat = Eigen::Quaternion<double, Eigen::DontAlign>;

static_assert(alignof(Vec3) == alignof(double) && alignof(Mat3) == alignof(double));
static_assert(alignof(Vec6) == alignof(double) && alignof(Mat6) == alignof(double));
static_assert(alignof(Quat) == alignof(double));

/// A point of a cloud, single precision, metres; its frame is that of the cloud that holds it.
struct Point3f {
  float x = 0, y = 0, z = 0;
};

}  // namespace paloc
