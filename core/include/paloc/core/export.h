#pragma once

/// All targets are built with hidden visibility; this marks what a library shows to others.
#define PALOC_EXPORT __attribute__((visibility("default")))
