// SPDX-License-Identifier: Apache-2.0
// Tiles of neighbouring rays, numbered row by row.
#ifndef VANTAGE_LIB_TILES
#define VANTAGE_LIB_TILES
#include "lib/parameters.glsl"

uint tiles_in_row() { return (parameters.columns + tile_side - 1u) / tile_side; }
uint first_row_of(uint tile) { return tile / tiles_in_row() * tile_side; }
uint first_column_of(uint tile) { return tile % tiles_in_row() * tile_side; }

#endif
