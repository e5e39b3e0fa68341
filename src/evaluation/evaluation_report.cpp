#include "evaluation_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <utility>

namespace tet_line_tracker {
namespace {

using Values = std::vector<std::pair<std::string, double>>;

/// Every measure by name; the names are those of the CSV and JSON files.
Values valuesOf(const TrackMeasures& m, const ThreeViewMeasures& three_view) {
  Values values{{"images", static_cast<double>(m.images)},
                {"tracks", static_cast<double>(m.tracks)},
                {"lines_per_image", m.lines_per_image},
                {"coverage", m.coverage},
                {"line_length_px", m.line_length},
                {"track_length", m.track_length},
                {"detections", m.detections},
                {"matches_per_pair", m.matches_per_pair},
                {"homography_ratio", m.homography_ratio},
                {"judged_pairs", static_cast<double>(m.judged_pairs)},
                {"unjudged_pairs", static_cast<double>(m.unjudged_pairs)},
                {"inlier_ratio_2px", m.inlier_ratio},
                {"inlier_ratio_1px", m.tight_inlier_ratio},
                {"error_median_px", m.median_error},
                {"error_p95_px", m.p95_error}};
  for (std::size_t n = 0; n < TrackMeasures::kDriftAges.size(); ++n) {
    const std::string age = std::to_string(TrackMeasures::kDriftAges[n]);
    values.emplace_back("drift_" + age + "_median_px", m.drift[n]);
    values.emplace_back("drift_" + age + "_p95_px", m.drift_p95[n]);
  }
  const TripleAgreement agreement = compareJudges(three_view, m.pairs);
  const Values rest{{"clean_length", m.clean_length},
                    {"survival", m.survival},
                    {"sigma_spread", m.sigma_spread},
                    {"ms_mean", m.ms_mean},
                    {"ms_p99", m.ms_p99},
                    {"pyramid_ms", m.pyramid_ms},
                    {"prior_ms", m.prior_ms},
                    {"flow_ms", m.flow_ms},
                    {"refine_ms", m.refine_ms},
                    {"detect_ms", m.detect_ms},
                    {"undistort_ms", m.undistort_ms},
                    {"triples", static_cast<double>(three_view.triples)},
                    {"three_view_ratio_2px", three_view.inlier_ratio},
                    {"three_view_ratio_1px", three_view.tight_inlier_ratio},
                    {"three_view_left_out_ratio", three_view.left_out_ratio},
                    {"three_view_refuted_ratio", three_view.refuted_ratio},
                    {"both_judges_three_view_ratio_2px", agreement.three_view_ratio},
                    {"both_judges_exact_ratio_2px", agreement.exact_ratio}};
  values.insert(values.end(), rest.begin(), rest.end());
  return values;
}

struct LengthClass {
  std::string name;
  AbsoluteErrors errors;
};

std::vector<LengthClass> lengthClasses(const AbsoluteMeasures& absolute) {
  std::vector<LengthClass> classes;
  const auto& lengths = AbsoluteMeasures::kLengths;
  for (std::size_t i = 0; i < absolute.classes.size(); ++i) {
    const std::string low = std::to_string(std::lround(lengths[i]));
    const bool last = i + 1 == absolute.classes.size();
    classes.push_back(
        {last ? low + "-up" : low + "-" + std::to_string(std::lround(lengths[i + 1])), absolute.classes[i]});
  }
  classes.push_back({"all", absolute.all});
  return classes;
}

/// The same for absolute errors.
Values absoluteValuesOf(const AbsoluteMeasures& absolute) {
  Values values{{"tracks_per_edge", absolute.tracks_per_edge}};
  for (const LengthClass& c : lengthClasses(absolute)) {
    std::string prefix = "absolute_" + c.name + "_";
    std::replace(prefix.begin(), prefix.end(), '-', '_');
    const AbsoluteErrors& e = c.errors;
    const Values rest{{"lines", static_cast<double>(e.lines)},
                      {"judged", static_cast<double>(e.judged)},
                      {"ambiguous", static_cast<double>(e.ambiguous)},
                      {"worse_end_median_px", e.worse_median},
                      {"worse_end_p90_px", e.worse_p90},
                      {"middle_median_px", e.middle_median},
                      {"middle_p90_px", e.middle_p90},
                      {"normalized_ends", e.normalized},
                      {"normalized_ends_rms", e.normalized_rms},
                      {"normalized_worse_end_median", e.normalized_worse},
                      {"normalized_middle", e.normalized_middle}};
    for (const auto& [name, value] : rest) values.emplace_back(prefix + name, value);
  }
  return values;
}

/// The same for what lines are on.
Values surfaceValuesOf(const std::vector<SurfaceMeasures>& surfaces) {
  Values values;
  for (int i = 0; i < kSurfaceKinds; ++i) {
    SurfaceMeasures measures;
    for (const SurfaceMeasures& m : surfaces) {
      if (m.kind == static_cast<SurfaceKind>(i)) measures = m;
    }
    const std::string prefix = std::string("surface_") + nameOf(static_cast<SurfaceKind>(i)) + "_";
    const Values rest{{"tracks", static_cast<double>(measures.tracks)},
                      {"line_share", measures.line_share},
                      {"track_length", measures.track_length},
                      {"inlier_ratio_2px", measures.inlier_ratio}};
    for (const auto& [name, value] : rest) values.emplace_back(prefix + name, value);
  }
  return values;
}

std::string number(double value, const char* format, const char* unknown) {
  if (!std::isfinite(value)) return unknown;
  char text[64];
  std::snprintf(text, sizeof(text), format, value);
  return text;
}

std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    if (static_cast<unsigned char>(c) >= 0x20) out += c;
  }
  return out + "\"";
}

template <class Container, class Write>
void writeArray(std::ostream& out, const Container& values, const Write& write) {
  out << "[";
  bool first = true;
  for (const auto& value : values) {
    if (!first) out << ", ";
    first = false;
    write(value);
  }
  out << "]";
}

void writeCounts(std::ostream& out, const std::vector<std::size_t>& counts) {
  writeArray(out, counts, [&out](std::size_t count) { out << count; });
}

void writeHistogram(std::ostream& out, const std::vector<PairError>& pairs) {
  constexpr double kBin = 0.05;
  constexpr std::size_t kBins = 81;  // the last one holds all from 4 px
  std::vector<std::size_t> counts(kBins, 0);
  for (const PairError& pair : pairs) {
    if (std::isnan(pair.error)) continue;
    ++counts[static_cast<std::size_t>(std::min(pair.error / kBin, static_cast<double>(kBins - 1)))];
  }
  out << "{\"bin_px\": " << kBin << ", \"counts\": ";
  writeCounts(out, counts);
  out << "}";
}

void writePairs(std::ostream& out, const std::vector<PairError>& pairs) {
  writeArray(out, pairs, [&out](const PairError& pair) {
    out << "[" << pair.frame << ", " << pair.id << ", " << number(pair.error, "%.4g", "null") << ", "
        << (!pair.judged_by_homography ? "null"
            : pair.homography_inlier   ? "true"
                                       : "false")
        << "]";
  });
}

std::size_t nameWidth(const std::vector<EvaluatedBag>& bags) {
  std::size_t width = 3;
  for (const EvaluatedBag& bag : bags) width = std::max(width, bag.name.size());
  return width;
}

void writeRow(std::ostream& out, const std::string& name, std::size_t width,
              const std::vector<std::string>& cells) {
  out << name << std::string(width - name.size(), ' ');
  for (const std::string& cell : cells) {
    out << " " << std::string(cell.size() < 6 ? 6 - cell.size() : 0, ' ') << cell;
  }
  out << "\n";
}

std::string cell(double value, const char* format) {
  return number(value, format, "-");
}

}  // namespace

void writeText(std::ostream& out, const std::vector<EvaluatedBag>& bags) {
  const std::size_t width = nameWidth(bags);
  const auto row = [&](const std::string& name, const std::vector<std::string>& cells) {
    writeRow(out, name, width, cells);
  };
  row("bag", {"truth",  "images", "lines",  "px",      "cover%",  "<2px%",  "<1px%", "err",
              "drift5", "10",     "20",     "30",      "length",  "clean",  "surv%", "sigma",
              "ms",     "ms p99", "homog%", "3v<2px%", "3v<1px%", "3vout%", "3vref%"});
  for (const EvaluatedBag& bag : bags) {
    const TrackMeasures& m = bag.measures;
    const auto& text = cell;
    row(bag.name, {bag.truth,
                   std::to_string(m.images),
                   text(m.lines_per_image, "%.1f"),
                   text(m.line_length, "%.1f"),
                   text(100.0 * m.coverage, "%.1f"),
                   text(100.0 * m.inlier_ratio, "%.2f"),
                   text(100.0 * m.tight_inlier_ratio, "%.2f"),
                   text(m.median_error, "%.3f"),
                   text(m.drift[0], "%.3f"),
                   text(m.drift[1], "%.3f"),
                   text(m.drift[2], "%.3f"),
                   text(m.drift[3], "%.3f"),
                   text(m.track_length, "%.1f"),
                   text(m.clean_length, "%.1f"),
                   text(100.0 * m.survival, "%.1f"),
                   text(m.sigma_spread, "%.2f"),
                   text(m.ms_mean, "%.2f"),
                   text(m.ms_p99, "%.2f"),
                   text(100.0 * m.homography_ratio, "%.1f"),
                   text(100.0 * bag.three_view.inlier_ratio, "%.2f"),
                   text(100.0 * bag.three_view.tight_inlier_ratio, "%.2f"),
                   text(100.0 * bag.three_view.left_out_ratio, "%.2f"),
                   text(100.0 * bag.three_view.refuted_ratio, "%.2f")});
  }
}

void writeAbsoluteText(std::ostream& out, const std::vector<EvaluatedBag>& bags) {
  const std::size_t width = nameWidth(bags);
  writeRow(out, "bag", width,
           {"length", "lines", "judged%", "ambig%", "worse", "worse90", "middle", "mid90", "norm", "rms",
            "normworse", "normmid", "tracks/edge"});
  for (const EvaluatedBag& bag : bags) {
    for (const LengthClass& c : lengthClasses(bag.absolute.value_or(AbsoluteMeasures()))) {
      const AbsoluteErrors& e = c.errors;
      const auto percent = [&](std::size_t part) {
        return cell(100.0 * static_cast<double>(part) / static_cast<double>(e.lines), "%.1f");
      };
      const bool all = c.name == "all";
      if (!bag.absolute && !all) continue;
      writeRow(out, bag.name, width,
               {c.name, bag.absolute ? std::to_string(e.lines) : "-", percent(e.judged), percent(e.ambiguous),
                cell(e.worse_median, "%.3f"), cell(e.worse_p90, "%.3f"), cell(e.middle_median, "%.3f"),
                cell(e.middle_p90, "%.3f"), cell(e.normalized, "%.2f"), cell(e.normalized_rms, "%.2f"),
                cell(e.normalized_worse, "%.2f"), cell(e.normalized_middle, "%.2f"),
                all && bag.absolute ? cell(bag.absolute->tracks_per_edge, "%.2f") : "-"});
    }
  }
}

void writeSurfaceText(std::ostream& out, const std::vector<EvaluatedBag>& bags) {
  const std::size_t width = nameWidth(bags);
  writeRow(out, "bag", width, {"surface", "lines%", "tracks", "length", "<2px%"});
  for (const EvaluatedBag& bag : bags) {
    if (bag.surfaces.empty()) writeRow(out, bag.name, width, {"      -", "-", "-", "-", "-"});
    for (const SurfaceMeasures& m : bag.surfaces) {
      if (m.tracks == 0) continue;
      const std::string kind = nameOf(m.kind);
      writeRow(
          out, bag.name, width,
          {std::string(7 - kind.size(), ' ') + kind, cell(100.0 * m.line_share, "%.1f"),
           std::to_string(m.tracks), cell(m.track_length, "%.1f"), cell(100.0 * m.inlier_ratio, "%.2f")});
    }
  }
}

void writeCsv(std::ostream& out, const std::vector<EvaluatedBag>& bags) {
  const auto any = [&](const auto& has) { return std::any_of(bags.begin(), bags.end(), has); };
  const bool absolute = any([](const EvaluatedBag& bag) { return bag.absolute.has_value(); });
  const bool surfaces = any([](const EvaluatedBag& bag) { return !bag.surfaces.empty(); });
  const auto writeNames = [&](const Values& values) {
    for (const auto& value : values) out << "," << value.first;
  };
  const auto writeValues = [&](const Values& values, bool known) {
    for (const auto& value : values) out << "," << (known ? number(value.second, "%.9g", "") : "");
  };
  out << "bag,truth";
  writeNames(valuesOf({}, {}));
  if (absolute) writeNames(absoluteValuesOf({}));
  if (surfaces) writeNames(surfaceValuesOf({}));
  out << "\n";
  for (const EvaluatedBag& bag : bags) {
    out << quoted(bag.name) << "," << bag.truth;
    writeValues(valuesOf(bag.measures, bag.three_view), true);
    if (absolute) {
      writeValues(absoluteValuesOf(bag.absolute.value_or(AbsoluteMeasures())), bag.absolute.has_value());
    }
    if (surfaces) writeValues(surfaceValuesOf(bag.surfaces), !bag.surfaces.empty());
    out << "\n";
  }
}

void writeJson(std::ostream& out, const std::vector<EvaluatedBag>& bags, bool with_pairs) {
  writeArray(out, bags, [&](const EvaluatedBag& bag) {
    const TrackMeasures& m = bag.measures;
    out << "{\"bag\": " << quoted(bag.name) << ", \"truth\": " << quoted(bag.truth);
    const auto writeValues = [&](const Values& values) {
      for (const auto& [name, value] : values) {
        out << ",\n  " << quoted(name) << ": " << number(value, "%.9g", "null");
      }
    };
    writeValues(valuesOf(m, bag.three_view));
    if (bag.absolute) writeValues(absoluteValuesOf(*bag.absolute));
    if (!bag.surfaces.empty()) writeValues(surfaceValuesOf(bag.surfaces));
    out << ",\n  \"error_histogram\": ";
    writeHistogram(out, m.pairs);
    out << ",\n  \"survival_in_view\": ";
    writeCounts(out, m.survival_curve.in_view);
    out << ",\n  \"survival_covered\": ";
    writeCounts(out, m.survival_curve.covered);
    out << ",\n  \"seconds\": ";
    writeArray(out, m.seconds, [&out](double seconds) { out << number(seconds, "%.6f", "null"); });
    out << ",\n  \"lines\": ";
    writeCounts(out, m.lines);
    if (with_pairs) {
      // frame, id, error [px], agrees with the homography
      out << ",\n  \"pairs\": ";
      writePairs(out, m.pairs);
    }
    out << "}";
  });
  out << "\n";
}

}  // namespace tet_line_tracker
