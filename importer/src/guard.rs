//! Turns a panic inside a library into a refusal, without a word on stderr.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::panic::{self, AssertUnwindSafe};
use std::sync::Once;

use crate::ImportError;

thread_local! {
    /// How many guards this thread is inside: the panic hook is silent only there.
    static DEPTH: Cell<u32> = const { Cell::new(0) };
    static LOCATION: RefCell<Option<String>> = const { RefCell::new(None) };
}

static HOOK: Once = Once::new();

/// Runs `work`; a panic becomes [`ImportError::Panic`] with `stage` as its place and, in its reason, the panic's
/// message and where in the code it came from.
pub(crate) fn catch<T>(stage: &str, work: impl FnOnce() -> Result<T, ImportError>) -> Result<T, ImportError> {
    catch_panic(work)
        .unwrap_or_else(|said| Err(ImportError::panic(stage, format!("a library panicked: {said}"))))
}

/// Runs `work` with a silent panic hook on this thread; panics outside a guard keep the hook they had.
///
/// # Errors
/// What the panic said, and the line of code that it came from.
pub fn catch_panic<T>(work: impl FnOnce() -> T) -> Result<T, String> {
    HOOK.call_once(|| {
        let previous = panic::take_hook();
        panic::set_hook(Box::new(move |info| {
            if DEPTH.get() == 0 {
                previous(info);
            } else {
                let location = info.location().map(|at| format!("{}:{}", base_name(at.file()), at.line()));
                LOCATION.set(location);
            }
        }));
    });
    DEPTH.set(DEPTH.get() + 1);
    let outcome = panic::catch_unwind(AssertUnwindSafe(work));
    DEPTH.set(DEPTH.get() - 1);
    outcome.map_err(|payload| {
        let at = LOCATION.take().map(|location| format!(" ({location})")).unwrap_or_default();
        format!("{}{at}", message(payload.as_ref()))
    })
}

/// The crate-relative end of a source path: the rest names the machine it was built on.
fn base_name(file: &str) -> &str {
    file.rsplit(['/', '\\']).next().unwrap_or(file)
}

fn message(payload: &(dyn Any + Send)) -> &str {
    payload
        .downcast_ref::<&str>()
        .copied()
        .or_else(|| payload.downcast_ref::<String>().map(String::as_str))
        .unwrap_or("no message")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_becomes_a_refusal_with_its_message() {
        let outcome: Result<(), _> = catch("read", || panic!("index {} out of range", 7));
        let error = outcome.unwrap_err();
        assert_eq!(error.code(), "panic");
        assert_eq!(error.place(), "read");
        assert!(error.reason().contains("index 7 out of range (guard.rs:"), "{}", error.reason());
    }

    #[test]
    fn a_panic_comes_back_with_its_message_and_its_line() {
        let caught = catch_panic(|| -> u32 { panic!("corner {} is missing", 7) });
        let text = caught.expect_err("it panicked");
        assert!(text.starts_with("corner 7 is missing (guard.rs:"), "{text}");
        assert_eq!(catch_panic(|| 5), Ok(5));
    }

    #[test]
    fn guards_nest() {
        let outcome = catch("outer", || {
            let inner: Result<(), _> = catch("inner", || panic!("deep"));
            assert!(inner.is_err());
            Ok(5)
        });
        assert_eq!(outcome.unwrap(), 5);
        assert_eq!(DEPTH.get(), 0);
    }
}
