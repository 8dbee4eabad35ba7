//! Ctrl-C: the first ends the work after the models in hand, the second at once.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use super::output;

static STOP: AtomicBool = AtomicBool::new(false);
static HANDLER: OnceLock<()> = OnceLock::new();

const INTERRUPTED: i32 = 130;

/// The flag that the first Ctrl-C sets; from the first call on Ctrl-C is handled.
pub(super) fn flag() -> &'static AtomicBool {
    HANDLER.get_or_init(|| {
        let handled = ctrlc::set_handler(|| {
            if STOP.swap(true, Ordering::Relaxed) {
                std::process::exit(INTERRUPTED);
            }
            output::notice("stopping after the models in hand; once more to stop at once");
        });
        if handled.is_err() {
            // Without a handler Ctrl-C ends the process at once, which loses no more than a power cut does.
            output::notice("note: Ctrl-C cannot be handled here and will stop at once");
        }
    });
    &STOP
}
