// Finds the usable times of a table. Spreadsheets show large numbers with few digits and save what
// they show, so that a column of microseconds holds 1.79549E+15 in each row.
//
// Units/frames: microseconds.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace dance {

class TableTimes {
 public:
  // Number of rows to check.
  static constexpr std::size_t kRows = 512;
  // Coarser numbers are no times of poses.
  static constexpr double kCoarsest_us = 1000.0;

  // The cells of a row, up to kRows of them; "" where one is empty.
  void look(std::string_view guest, std::string_view received, std::string_view capture);

  // A column without cells is neither usable nor rounded.
  bool is_received_usable() const { return received_.is_usable(); }
  bool is_received_rounded() const { return received_.is_rounded(); }
  bool is_capture_usable() const { return capture_.is_usable(); }
  bool is_capture_rounded() const { return capture_.is_rounded(); }
  // A cell that is rounded, as it stands in the table.
  const std::string& example() const {
    return received_.example.empty() ? capture_.example : received_.example;
  }

 private:
  struct Column {
    std::map<std::string, std::string, std::less<>> last;  // cell of each guest
    std::size_t steps = 0;                                 // from row to row of a guest
    std::size_t still = 0;                                 // of them without a change
    bool is_coarse = false;
    std::string example;

    void look(std::string_view guest, std::string_view cell);
    bool is_rounded() const { return is_coarse || (steps > 0 && 2 * still >= steps); }
    bool is_usable() const { return !last.empty() && !is_rounded(); }
  };
  Column received_;
  Column capture_;
};

}  // namespace dance
