#pragma once

#include "input_file.h"
#include "memory_budget.h"

namespace paloc {

/// Whether a file begins as gzip does (RFC 1952).
bool isGzip(const InputFile& file);

/// The content of a gzipped file, all members of it one after the other, in memory. Throws IoError
/// when it is damaged or cut off, holds nothing, or outgrows the budget: it is asked piece by
/// piece, since a gzip file can grow by a factor of a thousand.
InputFile unpackGzip(const InputFile& packed, const MemoryBudget& budget);

}  // namespace paloc
