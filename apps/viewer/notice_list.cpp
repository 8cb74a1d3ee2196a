#include "apps/viewer/notice_list.hpp"

namespace brume::viewer {

void NoticeList::add(const std::string& line) {
  notices_.push_back({line, Clock::now()});
  if (notices_.size() > kMost) notices_.pop_front();
}

std::vector<std::string> NoticeList::recent() {
  const auto oldest = Clock::now() - std::chrono::duration<double>(kSeconds);
  while (!notices_.empty() && notices_.front().time < oldest) notices_.pop_front();
  std::vector<std::string> lines;
  for (const Notice& notice : notices_) lines.push_back(notice.line);
  return lines;
}

}  // namespace brume::viewer
