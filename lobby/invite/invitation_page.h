// An invitation that a guest can read: as one HTML page, and as a text message. The page has no
// script, and a browser loads nothing else for it.
//
// Threads:      any.
// Failure:      a link that is not an invitation is an Error. It does not quote the link, which may
//               contain the key.
#pragma once

#include <string>

#include "core/base/result.h"
#include "tunnel/invitation/invitation.h"
#include "viewer/words/texts.h"

namespace dance {

// The networks from which guests reach a server, judged by its address alone.
enum class InvitationReach { kThisComputer, kHomeNetwork, kEverywhere };
InvitationReach reach_of(const std::string& host);

// `from` is the name of the guest who invites. HTML, UTF-8.
Result<std::string> invitation_page(const Texts& texts, const std::string& from,
                                    const std::string& link);
// Plain text, for a messenger.
Result<std::string> invitation_message(const Texts& texts, const std::string& from,
                                       const std::string& link);

}  // namespace dance
