component fettle_watch """Misses the heartbeat of a client, by the clock.

The stock component watchdog counts periods. A servo thread that was held up makes up for it in a burst of periods, in which no
client can beat; here that is no silence.""";

pin in u32 beat "goes on counting while the client lives";
pin in bit enable "a client is at work";
pin in float patience "without a beat for so long it is missed, s";
pin out bit missed "until enable has been false";

variable rtapi_u32 last_beat;
variable rtapi_s64 beaten_at;

option singleton yes;
function _ fp;
license "GPL"; // GPL-2.0-or-later, or Apache-2.0 as the rest of fettle
author "the authors of fettle";
;;
FUNCTION(_) {
    const rtapi_s64 now = rtapi_get_time(); /* ns */
    if (!enable || beat != last_beat) beaten_at = now;
    last_beat = beat;
    if (!enable) missed = 0;
    else if (now - beaten_at > (rtapi_s64)(patience * 1e9)) missed = 1;
}
