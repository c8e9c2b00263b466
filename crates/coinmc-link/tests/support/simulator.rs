//! A simulated microcontroller as a process: its terminal, and orders to it.

use std::fs::{File, OpenOptions};
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

pub struct Simulator {
    child: Child,
    said: Receiver<String>,
    /// QEMU, which has its own orders, and no measure of time but ours.
    pub qemu: bool,
    /// Longest time with current since this was taken, ms of the simulation, if it is measured there.
    pub longest_ms: Option<u64>,
    /// Likewise, how long the motors had current after the emergency stop was pressed.
    pub stop_ms: f64,
}

impl Simulator {
    /// Starts the simulator; also returns its serial line, and what arrives from it.
    pub fn start(command: &str) -> (Self, File, Receiver<Vec<u8>>) {
        let mut words = command.split_whitespace();
        let mut child = Command::new(words.next().expect("a command"))
            .args(words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .expect("the simulator starts");
        let mut lines = BufReader::new(child.stdout.take().expect("its output")).lines();
        let name = lines.find_map(|line| {
            let line = line.expect("text");
            let name = line.split_whitespace().find(|w| w.starts_with("/dev/"));
            name.map(str::to_owned)
        });
        let name = name.expect("the name of a terminal");
        // keep reading, so that its pipe does not fill up
        let (sender, said) = channel();
        std::thread::spawn(move || {
            lines
                .map_while(Result::ok)
                .all(|line| sender.send(line).is_ok())
        });
        let status = Command::new("stty")
            .args(["-F", &name, "raw", "-echo"])
            .status();
        assert!(status.expect("stty runs").success());
        let line = OpenOptions::new().read(true).write(true).open(&name);
        let line = line.expect("the terminal opens");
        let mut reader = line.try_clone().expect("a second handle");
        let (sender, arriving) = channel();
        std::thread::spawn(move || {
            let mut buffer = [0; 256];
            while let Ok(length @ 1..) = reader.read(&mut buffer) {
                if sender.send(buffer[..length].to_vec()).is_err() {
                    break;
                }
            }
        });
        let qemu = command.contains("qemu");
        let mut simulator = Self {
            child,
            said,
            qemu,
            longest_ms: None,
            stop_ms: 0.0,
        };
        if qemu {
            // its buttons read low until they were used once
            simulator.tell("sendkey up-ctrl 50");
            std::thread::sleep(Duration::from_millis(300));
        }
        (simulator, line, arriving)
    }

    pub fn tell(&mut self, order: &str) {
        let input = self.child.stdin.as_mut().expect("its input");
        writeln!(input, "{order}").expect("the simulator obeys");
    }

    /// Whether the motors have current.
    pub fn motors_on(&mut self) -> bool {
        if self.qemu {
            // port D of the LM3S, pin 0
            return self.pin("40007004");
        }
        let words = self.answer("motors", "motors ");
        let [now, longest] = [0, 1].map(|word| words[word].parse().expect("a number"));
        self.longest_ms = self.longest_ms.max(Some(longest));
        self.stop_ms = words[2].parse().expect("a number");
        now > 0
    }

    /// Whether a pin is high, by the address of its register.
    fn pin(&mut self, address: &str) -> bool {
        let words = self.answer(&format!("xp /1wx 0x{address}"), &format!("{address}: "));
        words[0] != "0x00000000"
    }

    /// The words behind a mark, in what the simulator says to an order.
    fn answer(&mut self, order: &str, mark: &str) -> Vec<String> {
        self.tell(order);
        loop {
            let line = self.said.recv_timeout(Duration::from_secs(20));
            let line = line.expect("the simulator answers");
            if let Some((_, rest)) = line.split_once(mark) {
                return rest.split_whitespace().map(str::to_owned).collect();
            }
        }
    }

    /// Presses the emergency stop.
    pub fn press(&mut self) {
        if self.qemu {
            self.tell("sendkey ctrl 2000");
            // port F, pin 1
            self.wait_for("40025008", false);
        } else {
            self.tell("press");
        }
    }

    /// QEMU's buttons read low until they were used once, also after a reset.
    pub fn use_button(&mut self, button: &str) {
        if self.qemu {
            self.tell(&format!("sendkey {button} 50"));
            std::thread::sleep(Duration::from_millis(300));
        }
    }

    /// Stops the program's main loop, as an error in it would.
    pub fn hang(&mut self) {
        self.tell(if self.qemu {
            "sendkey down 1500"
        } else {
            "hang"
        });
    }

    /// The program will no longer hang, once the chip was reset.
    pub fn recover(&mut self) {
        if !self.qemu {
            self.tell("recover");
        }
    }

    /// Waits until a key can be pressed at once: QEMU pauses after a key for as long as it was held.
    pub fn settle(&mut self) {
        if self.qemu {
            self.tell("sendkey up 300");
            self.wait_for("40024004", false);
            self.wait_for("40024004", true);
            std::thread::sleep(Duration::from_millis(500));
        }
    }

    pub fn release(&mut self) {
        if self.qemu {
            self.wait_for("40025008", true);
        } else {
            self.tell("release");
        }
    }

    /// Holds every motion; QEMU only for 13 s of its time, longer than any limit.
    pub fn stick(&mut self) {
        if self.qemu {
            self.tell("sendkey up 13000");
            // port E, pin 0
            self.wait_for("40024004", false);
        } else {
            self.tell("stick");
        }
    }

    pub fn unstick(&mut self) {
        if self.qemu {
            self.wait_for("40024004", true);
        } else {
            self.tell("unstick");
        }
    }

    fn wait_for(&mut self, address: &str, high: bool) {
        while self.pin(address) != high {
            std::thread::sleep(Duration::from_millis(20));
        }
    }
}

impl Drop for Simulator {
    fn drop(&mut self) {
        // one simulator exits at the end of its input, the other must be killed
        drop(self.child.stdin.take());
        for _ in 0..20 {
            if self.child.try_wait().is_ok_and(|ended| ended.is_some()) {
                return;
            }
            std::thread::sleep(Duration::from_millis(10));
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
