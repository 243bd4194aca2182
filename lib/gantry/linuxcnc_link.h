#pragma once

#include <Eigen/Core>

#include <array>
#include <memory>
#include <string>

namespace fettle {

/// The connection to a running LinuxCNC: commands by NML, the head's signals by HAL (samples/machines/linuxcnc).
/// Lengths are the machine's, mm. While it stands, the guard's heartbeat goes on; when its process is gone, it stops.
class LinuxcncLink {
  public:
    /// @param ini  the file that LinuxCNC was started with
    /// @throws InputError if there is no such file or setting, GantryFault if LinuxCNC does not answer
    explicit LinuxcncLink(const std::string& ini);
    ~LinuxcncLink();
    LinuxcncLink(const LinuxcncLink&) = delete;
    LinuxcncLink& operator=(const LinuxcncLink&) = delete;

    double setting(const std::string& section, const std::string& key) const;

    /// Switches the machine on, homes it where it is not, and lets the guard watch over the client.
    void enable();
    /// Sends a line of G-code and returns when it is under way. The last one's motion may be, too.
    void say(const std::string& line);
    /// Stops, and forgets what was said.
    void abort();
    /// Has all that was said been done? @throws GantryFault if the machine is off, the guard has struck, or LinuxCNC
    /// reports an error
    bool done();
    /// Where the probe tripped last, z; NaN if it did not.
    double touched() const;

    Eigen::Vector3d drives() const;
    double deflection() const; ///< mm
    double force() const;      ///< N
    bool held() const;         ///< by the guard, for more than F_max

    void set_most_force(double force); ///< F_max, N
    void set_hold(bool armed);         ///< by F_max
    void set_touch(bool armed);        ///< a contact trips the probe
    void set_tip(bool probe);          ///< the probe is in the place of the wheel
    /// Z goes up and down between where it is commanded and `lowest`, as a deflection of `wanted` asks, mm; without, it
    /// comes back to where it is commanded.
    void set_press(bool armed, double wanted = 0, double lowest = 0);

  private:
    struct Wires;
    std::unique_ptr<Wires> wires_;
};

} // namespace fettle
