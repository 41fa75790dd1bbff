// DemoRun: starts the programs of a planned demo, keeps them going (one that dies is started again
// while the others go on), and ends with the figures of every dancer.
//
// Units/frames: times of this machine's clock.
// Ownership:    owns the programs, the monitor and its two buses; the programs end with it.
// Threads:      none inside; runs its poller in the caller's thread.
// Failure:      run() names the program that could not be started, or houses that never met.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/demo/demo_beats.h"
#include "apps/demo/demo_monitor.h"
#include "apps/demo/demo_options.h"
#include "apps/demo/demo_pictures.h"
#include "core/bus/bus.h"
#include "core/net/poller.h"
#include "core/program/child_process.h"

namespace dance {

struct DemoResult {
  std::vector<DancerAccount> accounts;
  double seconds = 0.0;
  std::vector<std::string> pictures;
  std::string log;
  int restarts = 0;
  std::string
      house_reports[2];  // JSON that each house's program printed at its end; "" if it was killed
  std::optional<DemoRhythm> rhythm;  // of the comparison
  DemoPictures comparison;
  std::string line_report;  // likewise of the emulated line
};

class DemoRun {
 public:
  static Result<std::unique_ptr<DemoRun>> prepare(const DemoOptions& options, DemoPlan plan);
  Result<DemoResult> run();

 private:
  // One program of the demo.
  struct Role {
    std::string name;  // in messages
    ChildProcess::Options how;
    std::unique_ptr<ChildProcess> process;
    MonoTime restart_at;
    bool is_over = false;  // ended as it should
  };

  DemoRun(const DemoOptions& options, DemoPlan plan);
  Role& add(const std::string& name, const std::string& program,
            std::vector<std::string> arguments);
  Result<void> start(Role& role);
  Result<void> start_houses();
  Result<void> wait_until_connected();
  Result<void> start_music();
  void wait_for_music();
  Result<void> start_dancers(MonoTime origin);
  Result<void> start_viewer();
  void run_until(MonoTime deadline);
  MonoTime restart_ended(MonoTime now);
  void stop_in_order();
  DemoResult result(MonoTime origin) const;
  Result<void> add_comparison(DemoResult& result) const;
  std::string report_file(const std::string& name) const {
    return programs_folder(options_) + "/" + name + ".json";
  }

  DemoOptions options_;
  DemoPlan plan_;
  std::unique_ptr<Poller> poller_;
  std::unique_ptr<Bus> bus_a_;
  std::unique_ptr<Bus> bus_b_;
  std::unique_ptr<DemoMonitor> monitor_;
  std::unique_ptr<DemoBeats> beats_;
  std::unique_ptr<DemoTrace> trace_;  // of a comparison
  std::vector<std::unique_ptr<Role>> roles_;
  Role* viewer_ = nullptr;
  std::vector<Role*> dancers_;
  MonoTime end_;
  bool ending_ = false;
  int restarts_ = 0;
};

}  // namespace dance
