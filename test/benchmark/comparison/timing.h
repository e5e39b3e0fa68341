#pragma once

#include <string>
#include <vector>

namespace tet_line_tracker {

/// Times of one thing, image by image [ms]: of the processor on this thread, so that other programs on the
/// machine count as little as can be.
class Times {
 public:
  template <typename Body>
  void add(const Body& body) {
    const double begin = threadMilliseconds();
    body();
    values_.push_back(threadMilliseconds() - begin);
  }

  /// A time that somebody else took [ms].
  void put(double milliseconds) { values_.push_back(milliseconds); }

  double minimum() const { return quantile(0.0); }
  double median() const { return quantile(0.5); }
  double percentile99() const { return quantile(0.99); }
  double mean() const;
  bool empty() const { return values_.empty(); }

 private:
  static double threadMilliseconds();
  double quantile(double share) const;

  std::vector<double> values_;
};

/// A table of times in Markdown, with each mean as a share of that of a row of one's choice.
class TimeTable {
 public:
  /// `what`: heading of the first column; `remark`: of the last one, none when empty.
  explicit TimeTable(std::string what, std::string remark = "")
      : what_(std::move(what)), remark_(std::move(remark)) {}
  void add(const std::string& name, const Times& times, const std::string& remark = "");
  /// Ratios are those of the mean of row `reference` (from 0) to the means of the others.
  void print(std::size_t reference) const;

 private:
  struct Row {
    std::string name;
    Times times;
    std::string remark;
  };
  std::string what_, remark_;
  std::vector<Row> rows_;
};

/// Exponent e of cost ~ size^e, by least squares on the logarithms.
double fittedExponent(const std::vector<double>& sizes, const std::vector<double>& costs);

}  // namespace tet_line_tracker
