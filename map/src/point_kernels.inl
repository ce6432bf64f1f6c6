// The text of PointKernels. It is compiled once for each set of instructions, within a namespace of
// its own, and calls nothing from outside: what it called would be compiled for one of them and
// used by all.

using Float8 = float __attribute__((vector_size(32)));
using Mask8 = std::int32_t __attribute__((vector_size(32)));  // all bits set, or none, a lane
using Points8 = Float8[3];

inline void load(const float* from, Float8& lanes) { __builtin_memcpy(&lanes, from, sizeof lanes); }
inline void store(float* to, const Float8& lanes) { __builtin_memcpy(to, &lanes, sizeof lanes); }

inline unsigned bitsOf(const Mask8& mask) {
#if defined(PALOC_KERNELS_AVX2)
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<const __m256&>(mask)));
#else
  unsigned bits = 0;
  for (int lane = 0; lane < 8; ++lane) bits |= static_cast<unsigned>(mask[lane] & 1) << lane;
  return bits;
#endif
}

#if defined(PALOC_KERNELS_AVX2)

// Writes the lanes whose bit is set one after the other, and something behind them.
inline void packColumn(const Float8& lanes, unsigned bits, float* to) {
  const __m256i order = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(kPackedLanes.of[bits]));
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps(lanes, order));
}

inline std::size_t pack(const Points8& points, unsigned bits, const PackedColumns& to,
                        std::size_t at) {
  packColumn(points[0], bits, to.x + at);
  packColumn(points[1], bits, to.y + at);
  packColumn(points[2], bits, to.z + at);
  return at + static_cast<std::size_t>(__builtin_popcount(bits));
}

// The numbers, from `first` on, of the bits that are set, and something behind them.
inline std::size_t packNumbers(std::uint32_t first, unsigned bits, std::uint32_t* to,
                               std::size_t at) {
  const __m256i lanes = _mm256_cvtepu8_epi32(_mm_cvtsi64_si128(kPackedLanes.of[bits]));
  const __m256i numbers = _mm256_add_epi32(lanes, _mm256_set1_epi32(static_cast<int>(first)));
  _mm256_storeu_si256(reinterpret_cast<__m256i_u*>(to + at), numbers);
  return at + static_cast<std::size_t>(__builtin_popcount(bits));
}

#else

inline std::size_t pack(const Points8& points, unsigned bits, const PackedColumns& to,
                        std::size_t at) {
  if (bits == 0xff) {
    store(to.x + at, points[0]), store(to.y + at, points[1]), store(to.z + at, points[2]);
    return at + 8;
  }
  // Written in any case: what is not to be kept is written over by the next.
  for (unsigned lane = 0; lane < 8; ++lane) {
    to.x[at] = points[0][lane], to.y[at] = points[1][lane], to.z[at] = points[2][lane];
    at += (bits >> lane) & 1U;
  }
  return at;
}

inline std::size_t packNumbers(std::uint32_t first, unsigned bits, std::uint32_t* to,
                               std::size_t at) {
  for (std::uint32_t lane = 0; lane < 8; ++lane) {
    to[at] = first + lane;
    at += (bits >> lane) & 1U;
  }
  return at;
}

#endif

inline void loadRelative(const float* x, const float* y, const float* z, const Place3f& from,
                         Points8& points) {
  load(x, points[0]), load(y, points[1]), load(z, points[2]);
  points[0] -= from.x, points[1] -= from.y, points[2] -= from.z;
}

inline void normSq(const Points8& p, Float8& sum) { sum = p[0] * p[0] + p[1] * p[1] + p[2] * p[2]; }

inline void heightOver(const Place3f& normal, const Points8& p, Float8& height) {
  height = p[0] * normal.x + p[1] * normal.y + p[2] * normal.z;
}

inline std::int32_t total(const Mask8& counts) {
  std::int32_t sum = 0;
  for (int lane = 0; lane < 8; ++lane) sum += counts[lane];
  return sum;
}

inline float total(const Float8& lanes) {
  const Float8& v = lanes;
  return ((v[0] + v[1]) + (v[2] + v[3])) + ((v[4] + v[5]) + (v[6] + v[7]));
}

inline float lesser(float a, float b) { return a < b ? a : b; }

// Lane by lane, without a branch: where the nearest is cannot be foreseen.
NearestOf nearest(const PointBlock* blocks, std::size_t count, const Place3f& place) {
  Float8 least_sq = Float8{} + __builtin_inff();
  Mask8 block_of_least{};
  for (std::size_t i = 0; i < count; ++i) {
    Points8 p;
    loadRelative(blocks[i].x, blocks[i].y, blocks[i].z, place, p);
    Float8 distance_sq;
    normSq(p, distance_sq);
    const Mask8 nearer = distance_sq < least_sq;
    least_sq = nearer ? distance_sq : least_sq;
    block_of_least = nearer ? Mask8{} + static_cast<std::int32_t>(i) : block_of_least;
  }
  const Float8& v = least_sq;
  const float least = lesser(lesser(lesser(v[0], v[1]), lesser(v[2], v[3])),
                             lesser(lesser(v[4], v[5]), lesser(v[6], v[7])));
  const unsigned bits = bitsOf(least_sq == least);
  const int lane = __builtin_ctz(bits);
  return {static_cast<std::uint32_t>(8 * block_of_least[lane] + lane), least};
}

// How far a coordinate lies outside eight intervals.
inline void outside(const float* low, const float* high, float value, Float8& apart) {
  Float8 below, above;
  load(low, below), load(high, above);
  below -= value, above = value - above;
  apart = below > above ? below : above;
  apart = apart > 0 ? apart : Float8{};
}

std::size_t nearBoxes(const BoxGroup* groups, const Numbers& numbers, const Place3f& place,
                      float reach_sq, std::uint32_t* near) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < numbers.count; ++i) {
    const std::uint32_t number = numbers.first[i];
    const BoxGroup& group = groups[number];
    Points8 apart;
    outside(group.low[0], group.high[0], place.x, apart[0]);
    outside(group.low[1], group.high[1], place.y, apart[1]);
    outside(group.low[2], group.high[2], place.z, apart[2]);
    Float8 distance_sq;
    normSq(apart, distance_sq);
    size = packNumbers(number * 8, bitsOf(distance_sq < reach_sq), near, size);
  }
  return size;
}

std::size_t gather(const PointBlock* blocks, const Numbers& numbers, const Place3f& place,
                   float reach_sq, const PackedColumns& to) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < numbers.count; ++i) {
    const std::uint32_t number = numbers.first[i];
    const PointBlock& block = blocks[number];
    Points8 p;
    loadRelative(block.x, block.y, block.z, place, p);
    Float8 distance_sq;
    normSq(p, distance_sq);
    size = pack(p, bitsOf(distance_sq < reach_sq), to, size);
  }
  return size;
}

std::size_t gatherAside(const PointBlock* blocks, const Numbers& numbers, const RegionAside& region,
                        const PackedColumns& to, std::uint32_t* indices) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < numbers.count; ++i) {
    const std::uint32_t number = numbers.first[i];
    const PointBlock& block = blocks[number];
    Points8 p;
    loadRelative(block.x, block.y, block.z, region.place, p);
    Float8 distance_sq, height;
    normSq(p, distance_sq);
    heightOver(region.normal, p, height);
    const Float8 height_sq = height * height;
    const unsigned bits = bitsOf((height_sq >= region.least_sq) & (height_sq <= region.most_sq) &
                                 (distance_sq - height_sq <= region.aside_sq));
    packNumbers(number * 8, bits, indices, size);
    size = pack(p, bits, to, size);
  }
  return size;
}

std::size_t select(const PointColumns& points, const Place3f& from, float radius_sq,
                   const PackedColumns& to) {
  std::size_t size = 0;
  for (std::size_t i = 0; i < points.size; i += 8) {
    Points8 p;
    loadRelative(points.x + i, points.y + i, points.z + i, from, p);
    Float8 distance_sq;
    normSq(p, distance_sq);
    size = pack(p, bitsOf(distance_sq <= radius_sq), to, size);
  }
  return size;
}

void distancesSq(const PointColumns& points, const Place3f& from, float* distances_sq) {
  for (std::size_t i = 0; i < points.size; i += 8) {
    Points8 p;
    loadRelative(points.x + i, points.y + i, points.z + i, from, p);
    Float8 distance_sq;
    normSq(p, distance_sq);
    store(distances_sq + i, distance_sq);
  }
}

std::int32_t countUpTo(const float* values, std::size_t size, float largest) {
  Mask8 counts{};
  for (std::size_t i = 0; i < size; i += 8) {
    Float8 lanes;
    load(values + i, lanes);
    counts -= lanes <= largest;  // a lane that holds is -1
  }
  return total(counts);
}

void heights(const PointColumns& points, const Place3f& normal, float* heights) {
  for (std::size_t i = 0; i < points.size; i += 8) {
    Points8 p;
    load(points.x + i, p[0]), load(points.y + i, p[1]), load(points.z + i, p[2]);
    Float8 height;
    heightOver(normal, p, height);
    store(heights + i, height);
  }
}

std::int32_t countNearPlane(const PointColumns& points, const Place3f& normal, float within_sq) {
  Mask8 counts{};
  for (std::size_t i = 0; i < points.size; i += 8) {
    Points8 p;
    load(points.x + i, p[0]), load(points.y + i, p[1]), load(points.z + i, p[2]);
    Float8 height;
    heightOver(normal, p, height);
    counts -= height * height < within_sq;
  }
  return total(counts);
}

template <bool kBand>
inline RegionSums sumsOf(const PointColumns& points, const RegionOfPoints& region) {
  Float8 first[3]{}, second[6]{};
  Mask8 counts{}, within{};
  for (std::size_t i = 0; i < points.size; i += 8) {
    Points8 p;
    loadRelative(points.x + i, points.y + i, points.z + i, region.from, p);
    Float8 distance_sq, height;
    normSq(p, distance_sq);
    Mask8 kept = distance_sq <= region.radius_sq;
    if constexpr (kBand) {
      heightOver(region.normal, p, height);
      within -= kept;
      kept &= (height >= region.low) & (height <= region.high);
    }
    counts -= kept;
    for (Float8& axis : p) axis = reinterpret_cast<Float8>(reinterpret_cast<Mask8>(axis) & kept);
    int at = 0;
    for (int a = 0; a < 3; ++a) {
      first[a] += p[a];
      for (int b = a; b < 3; ++b) second[at++] += p[a] * p[b];
    }
  }
  RegionSums sums;
  sums.count = total(counts);
  sums.within = kBand ? total(within) : sums.count;
  for (int i = 0; i < 3; ++i) sums.first[i] = total(first[i]);
  for (int i = 0; i < 6; ++i) sums.second[i] = total(second[i]);
  return sums;
}

RegionSums sumsIn(const PointColumns& points, const RegionOfPoints& region) {
  return sumsOf<true>(points, region);
}

RegionSums sumsWithin(const PointColumns& points, const Place3f& from, float radius_sq) {
  return sumsOf<false>(points, {from, radius_sq, {0, 0, 0}, 0, 0});
}

constexpr PointKernels kKernels{nearest,        nearBoxes,   gather,    gatherAside,
                                select,         distancesSq, countUpTo, heights,
                                countNearPlane, sumsIn,      sumsWithin};
