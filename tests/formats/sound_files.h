#pragma once
// Small sound files of each format, each with what its reader has a case for: made by our writers,
// or by hand where others write what we do not.

#include <string>
#include <vector>

namespace gonio::test {

using Files = std::vector<std::string>;

[[nodiscard]] Files soundGonio();
[[nodiscard]] Files soundGraw();
[[nodiscard]] Files soundZemax();
[[nodiscard]] Files soundLightTools();
[[nodiscard]] Files soundMerl();
[[nodiscard]] Files soundUtia();
[[nodiscard]] Files soundRgl();
[[nodiscard]] Files soundBird();
[[nodiscard]] Files soundSpeos();
[[nodiscard]] Files soundMbsdf();
[[nodiscard]] Files soundSsdd();
[[nodiscard]] Files soundCsv();
[[nodiscard]] Files soundAstm();
[[nodiscard]] Files soundPab();
[[nodiscard]] Files soundAlta();
[[nodiscard]] Files soundExrTiles();
[[nodiscard]] Files soundExrAtlas();
[[nodiscard]] Files soundRt300s();
[[nodiscard]] Files soundKlems();
[[nodiscard]] Files soundStil();
[[nodiscard]] Files soundPoints();
/// Beginnings of files, for whoever tells formats apart.
[[nodiscard]] Files soundHeads();

}  // namespace gonio::test
