#pragma once

#include <memory>
#include <string>

#include "edit/session/edit_session.h"

namespace uw {

/// The address of the editor. `everywhere` is for containers, whose ports are published on the
/// addresses of their host: requests come by the network then, but have to name 127.0.0.1 or
/// localhost as ever.
enum class EditAddress { this_machine, everywhere };

/// Serves the page of the lamp editor, and the session behind it as docs/edit-api.md says, on
/// 127.0.0.1. Whoever does not know the address's token, and any page of another origin, is
/// refused. Connections that say nothing cost nothing.
class EditServer {
  public:
    /// Listens to `port`, 0 for any that is free, from now on; `session` outlives it. Throws
    /// IoError if the port is taken.
    EditServer(EditSession& session, int port, EditAddress where = EditAddress::this_machine);
    ~EditServer();
    EditServer(const EditServer&) = delete;
    EditServer& operator=(const EditServer&) = delete;
    EditServer(EditServer&&) = delete;
    EditServer& operator=(EditServer&&) = delete;

    int port() const;
    /// 128 random bits as 32 hex digits.
    const std::string& token() const;
    /// "http://127.0.0.1:41873/0123.../"
    std::string address() const;

  private:
    class Page;
    std::unique_ptr<Page> page_;
};

}  // namespace uw
