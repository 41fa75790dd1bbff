#include "core/control/role_control.h"

#include <gtest/gtest.h>

#include "core/net/mono_clock.h"

namespace dance {
namespace {

constexpr const char* kRoleBus = "udpm://239.255.76.67:7753?ttl=0";

TEST(RoleControl, DeliversARoleOnlyToTheHouseOfItsDancer) {
  const GuestId ann = *GuestId::parse("ann"), bob = *GuestId::parse("bob");
  auto poller = Poller::create();
  ASSERT_TRUE(poller);
  std::vector<DanceRole> roles;
  auto control = open_role_control(
      kRoleBus, ann,
      [&](DanceRole role) {
        roles.push_back(role);
        if (roles.size() == 2) (*poller)->stop();
      },
      **poller);
  ASSERT_TRUE(control) << control.error().what;
  EXPECT_TRUE(has_role_control(kRoleBus, ann));
  EXPECT_FALSE(has_role_control(kRoleBus, bob));
  EXPECT_FALSE(send_role(kRoleBus, bob, DanceRole::kLead));
  ASSERT_TRUE(send_role(kRoleBus, ann, DanceRole::kFollow));
  ASSERT_TRUE(send_to_program(control_path("role", kRoleBus, ann), "dance"));
  ASSERT_TRUE(send_role(kRoleBus, ann, DanceRole::kEither));
  (*poller)->add_timer(mono_now() + Duration::s(5), [&](MonoTime) {
    (*poller)->stop();
    return MonoTime();
  });
  (*poller)->run();
  EXPECT_EQ(roles, (std::vector<DanceRole>{DanceRole::kFollow, DanceRole::kEither}));
  control->reset();
  EXPECT_FALSE(has_role_control(kRoleBus, ann));
}

}  // namespace
}  // namespace dance
