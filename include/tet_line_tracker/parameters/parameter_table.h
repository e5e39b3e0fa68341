#pragma once

#include <limits>
#include <map>
#include <string>
#include <variant>
#include <vector>

namespace tet_line_tracker {

/// Names, ranges and meaning of the fields of parameter structs: the one place from which the parameter
/// server, the command line, YAML files and README's table are served. Holds pointers into the structs, which
/// must outlive it.
class ParameterTable {
 public:
  /// When another value takes effect while images come.
  enum class Change {
    kBetweenImages,  ///< with the next image; the tracks go on
    kNewEpoch,       ///< the next image starts a new epoch: the tracks cannot go on
    kAtStart         ///< not before the program starts again
  };
  using Value = std::variant<bool, int, double, std::string>;

  struct Entry {
    std::string name;
    std::variant<bool*, int*, double*, std::string*> field;
    double min{-std::numeric_limits<double>::infinity()};
    double max{std::numeric_limits<double>::infinity()};
    bool odd{false};                   ///< only odd numbers
    std::vector<std::string> choices;  ///< of a text; empty: any
    std::string unit;                  ///< "px", "s", ...; empty: a number, a word or a switch
    std::string meaning;               ///< one sentence without a full stop
    Change change{Change::kBetweenImages};
  };

  Entry& add(std::string name, bool& field, std::string meaning);
  Entry& add(std::string name, int& field, int min, int max, std::string unit, std::string meaning);
  Entry& add(std::string name, double& field, double min, double max, std::string unit, std::string meaning);
  Entry& add(std::string name, std::string& field, std::vector<std::string> choices, std::string meaning);
  /// Takes over the entries of another part.
  void append(ParameterTable other);
  /// A name of earlier versions, and what became of it: "is now max_rotation". set() refuses it with that.
  void addRetired(std::string name, std::string fate);

  const std::vector<Entry>& entries() const { return entries_; }
  const Entry* find(const std::string& name) const;

  /// Sets a field from text as written on a command line or in YAML. Throws std::invalid_argument with one
  /// sentence that names the parameter, the value and what is needed; for an unknown name also the nearest
  /// known one.
  void set(const std::string& name, const std::string& text);

  /// The sentence for a name that the table does not hold: what became of it, or the nearest name that it
  /// does hold.
  std::string unknownName(const std::string& name) const;

  /// One sentence for each value out of its range, empty when all are fine.
  std::vector<std::string> check() const;

  static Value value(const Entry& entry);
  /// Sets the field as it is, in range or not. `value` is of the field's type.
  static void assign(const Entry& entry, const Value& value);
  static std::string valueText(const Entry& entry);  ///< as set() would read it
  static std::string rangeText(const Entry& entry);  ///< "3..21, odd", "true or false", "paper or joint"

 private:
  std::vector<Entry> entries_;
  std::map<std::string, std::string> retired_;
};

}  // namespace tet_line_tracker
