//! Instances as importers hold them: numbers for live instances, calls that cannot unwind, messages delivered when the
//! instance is free again, so that a callback may call back. Those of a step wait for its end, or for that of an
//! intermediate update; [`Phase::Stepping`](crate::phase::Phase) refuses what a callback must not do.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, MutexGuard, TryLockError, TryLockResult};

use enmm_handles::Table;

use crate::instance::{Instance, Step, Update};
use crate::log::{Message, Status};

/// The importer's side of an instance.
pub trait Host {
    /// Takes a message.
    fn log(&self, message: &Message);
}

/// A live instance with its importer.
#[derive(Debug)]
pub struct Handle<H> {
    instance: Mutex<Instance>,
    host: H,
}

/// How a step ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ended {
    /// Status of the call.
    pub status: Status,
    /// Time at which the instance stands (s).
    pub time: f64,
    /// Whether it ended before its end.
    pub early: bool,
}

impl<H: Host> Handle<H> {
    /// Does `work` on the instance; `function` stands before its messages. A panic is [`Status::Fatal`], and so is
    /// every later call.
    pub fn call(&self, function: &str, work: impl FnOnce(&mut Instance) -> Status) -> Status {
        let (status, messages) = attempt(self.instance.try_lock(), work);
        self.tell(function, messages);
        status
    }

    /// A whole step. The instance is free while `update` runs, which may return the time of an early return. Nothing
    /// touches the instance after the messages of the end are delivered.
    pub fn do_step(
        &self,
        function: &str,
        (t, h): (f64, f64),
        mut update: Option<&mut dyn FnMut(Update) -> Option<f64>>,
    ) -> Ended {
        let process = std::process::id();
        let mut begun: Option<Step> = None;
        let mut time = t;
        let (mut status, mut held) = attempt(self.instance.try_lock(), |instance| {
            let outcome = instance.begin_step(t, h);
            time = instance.time();
            outcome.map_or_else(
                |status| status,
                |step| {
                    begun = Some(step);
                    Status::Ok
                },
            )
        });
        let mut early = false;
        if let Some(mut step) = begun {
            let mut last_told = time;
            while status == Status::Ok && !step.is_done() {
                let mut told = None;
                status = self.go_on(process, &mut held, |instance| {
                    let status = instance.advance_step(&mut step);
                    let news = status == Status::Ok && update.is_some() && instance.time_of_model() > last_told;
                    told = news.then(|| instance.enter_update(&step));
                    time = instance.time();
                    status
                });
                let (Some(told), Some(update)) = (told, update.as_mut()) else { continue };
                last_told = told.time;
                let wanted = update(told).filter(|_| told.can_return_early);
                status = self.go_on(process, &mut held, |instance| {
                    let status = instance.leave_update(&mut step, wanted);
                    time = instance.time();
                    status
                });
                self.tell(function, std::mem::take(&mut held));
            }
            early = status == Status::Ok && step.is_early();
        }
        self.tell(function, held);
        Ended { status, time, early }
    }

    /// Goes on with a step that has begun. Another thread can have the instance only to be refused, or to read within
    /// an update: that is waited for, but not in a process that was forked within the update, which has no such thread.
    fn go_on(&self, process: u32, held: &mut Vec<Message>, work: impl FnOnce(&mut Instance) -> Status) -> Status {
        if std::process::id() != process {
            held.push(Message::error("a step ends in the process that began it, not in one forked during an update"));
            return Status::Error;
        }
        let (status, messages) = attempt(self.instance.lock().map_err(TryLockError::from), work);
        held.extend(messages);
        status
    }

    /// Delivers messages of a function.
    fn tell(&self, function: &str, messages: Vec<Message>) {
        for mut message in messages {
            message.text.insert_str(0, ": ");
            message.text.insert_str(0, function);
            self.host.log(&message);
        }
    }

    /// The importer's side.
    pub fn host(&self) -> &H {
        &self.host
    }
}

/// Does `work` on an instance if it is free, and takes the messages.
fn attempt(
    lock: TryLockResult<MutexGuard<'_, Instance>>,
    work: impl FnOnce(&mut Instance) -> Status,
) -> (Status, Vec<Message>) {
    let done = catch_unwind(AssertUnwindSafe(|| match lock {
        Ok(mut instance) => {
            let status = work(&mut instance);
            (status, instance.take_messages())
        }
        Err(TryLockError::WouldBlock) => {
            (Status::Error, vec![Message::error("the instance is busy with a call of another thread")])
        }
        Err(TryLockError::Poisoned(_)) => {
            (Status::Fatal, vec![Message::fatal("the instance is lost since an earlier panic: free it")])
        }
    }));
    done.unwrap_or_else(|panic| (Status::Fatal, vec![Message::fatal(format!("panic: {}", panic_text(panic.as_ref())))]))
}

fn panic_text(panic: &(dyn std::any::Any + Send)) -> &str {
    let text = panic.downcast_ref::<&str>().copied();
    text.or_else(|| panic.downcast_ref::<String>().map(String::as_str)).unwrap_or("without a message")
}

/// Instances of a library that are alive, by numbers that importers take for pointers.
pub type Live<H> = Table<Handle<H>>;

/// Adds an instance and returns its number; 0, and a message, when millions are alive.
pub fn enter<H: Host + Send + Sync>(live: &'static Live<H>, instance: Instance, host: H) -> usize {
    live.insert(Handle { instance: Mutex::new(instance), host }).unwrap_or_else(|handle| {
        handle.host.log(&Message::error("too many instances are alive: free those that are no longer needed"));
        0
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::instance::Plan;
    use crate::table::{self, Version};

    #[derive(Default)]
    struct Listener(Mutex<Vec<Message>>);

    impl Host for Listener {
        fn log(&self, message: &Message) {
            self.0.lock().unwrap().push(message.clone());
        }
    }

    fn instance(folder: &std::path::Path) -> Instance {
        let root = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
        let loaded = enmm_io::load_case(&root.join("examples/cases/block_on_incline.toml")).unwrap();
        std::fs::write(folder.join(crate::resource::FILE), crate::resource::encode(&loaded, "incline").unwrap())
            .unwrap();
        let model = loaded.cosimulation().unwrap();
        let token = table::Table::new(&loaded.case, model.blocks_max(), &loaded.hash, Version::Three).token;
        let plan = Plan {
            version: Version::Three,
            name: "a",
            token: &token,
            resources: folder,
            logging: false,
            early_return: true,
            event_mode: false,
        };
        Instance::new(plan).unwrap()
    }

    #[test]
    fn a_panic_is_fatal_and_logged_and_other_instances_go_on() {
        let folder = tempfile::tempdir().unwrap();
        static LIVE: Live<Listener> = Live::new(0x50);
        let numbers = [0, 1].map(|_| enter(&LIVE, instance(folder.path()), Listener::default()));
        let handle = LIVE.find(numbers[0]).unwrap();
        assert_eq!(handle.call("f", |_| panic!("broken")), Status::Fatal);
        assert_eq!(handle.call("g", |instance| instance.terminate()), Status::Fatal);
        let texts: Vec<String> = handle.host().0.lock().unwrap().iter().map(|m| m.text.clone()).collect();
        assert_eq!(texts[0], "f: panic: broken");
        assert!(texts[1].starts_with("g: the instance is lost"));
        LIVE.remove(numbers[0]).unwrap();
        assert!(LIVE.find(numbers[0]).is_err() && LIVE.find(0).is_err());
        let other = LIVE.find(numbers[1]).unwrap();
        assert_eq!(other.call("f", |instance| instance.enter_initialization(None)), Status::Ok);
        assert_eq!(other.call("f", |_| other.call("g", |_| Status::Ok)), Status::Error, "an instance within a call");
    }
}
