// SPDX-License-Identifier: Zlib
// SPDX-FileCopyrightText: 2026 the tetskin authors
#pragma once

#include <tetskin/bullet/src/base/build_stream.h>
#include <tetskin/contact/src/soft/shape_data.h>

#include <memory>

namespace tetskin::contact_detail {

/// Describes a contact shape, or builds it without its mesh. Bodies that share one share one again.
/// shape  to be described; not used when building
std::shared_ptr<const ContactShape> buildContactShape(bullet_detail::BuildStream& stream, const ContactShape* shape);

}  // namespace tetskin::contact_detail
