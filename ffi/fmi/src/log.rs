//! Messages to the importer: categories, what passes when, and the status that each call returns.

/// Status of a call, with the numbers of both standards.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(i32)]
pub enum Status {
    /// Done.
    Ok = 0,
    /// Done, with something to look at.
    Warning = 1,
    /// Not done; the instance is as before the call.
    Discard = 2,
    /// Not done; only a saved state, a reset or the end are left.
    Error = 3,
    /// The instance is lost.
    Fatal = 4,
}

/// Name and description of each category, as the model descriptions declare them, in the order of [`Category`].
pub const LOG_CATEGORIES: [(&str, &str); 6] = [
    ("logEvents", "Blocks that detach or fail, joints that slip"),
    ("logStatusWarning", "Warnings"),
    ("logStatusDiscard", "Calls that were refused and changed nothing"),
    ("logStatusError", "Errors"),
    ("logStatusFatal", "Errors after which the instance is lost"),
    ("logAll", "All messages"),
];

/// Category of a message.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// Blocks that detach or fail, joints that slip.
    Events,
    /// Something to look at.
    Warning,
    /// A step that could not be taken.
    Discard,
    /// A call that failed.
    Error,
    /// A panic.
    Fatal,
    /// Everything else; as a filter, everything.
    All,
}

impl Category {
    /// Name in the model description.
    pub fn name(self) -> &'static str {
        LOG_CATEGORIES[self as usize].0
    }
}

/// One message.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// Severity.
    pub status: Status,
    /// Category.
    pub category: Category,
    /// Text.
    pub text: String,
}

impl Message {
    /// A message of a failed call.
    pub fn error(text: impl Into<String>) -> Self {
        Self { status: Status::Error, category: Category::Error, text: text.into() }
    }

    /// A message of a lost instance.
    pub fn fatal(text: impl Into<String>) -> Self {
        Self { status: Status::Fatal, category: Category::Fatal, text: text.into() }
    }
}

/// Which messages pass. Those of failed calls always do, discarded steps included.
#[derive(Debug, Clone, Copy, Default)]
pub struct Filter {
    on: [bool; LOG_CATEGORIES.len()],
}

impl Filter {
    /// All categories on, or all off.
    pub fn new(on: bool) -> Self {
        Self { on: [on; LOG_CATEGORIES.len()] }
    }

    /// Only the named categories, or all when none is named; nothing when `on` is false.
    ///
    /// # Errors
    /// The first name that is no category.
    pub fn of<'a>(on: bool, names: &[&'a str]) -> Result<Self, &'a str> {
        let mut filter = Self::new(on && names.is_empty());
        for &name in names {
            let k = LOG_CATEGORIES.iter().position(|&(known, _)| known == name).ok_or(name)?;
            filter.on[k] = on;
        }
        Ok(filter)
    }

    /// Whether a message of this category passes.
    pub fn passes(&self, category: Category) -> bool {
        matches!(category, Category::Discard | Category::Error | Category::Fatal)
            || self.on[category as usize]
            || self.on[Category::All as usize]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn failures_always_pass_and_only_declared_categories_are_known() {
        let off = Filter::new(false);
        assert!(off.passes(Category::Error) && off.passes(Category::Fatal) && off.passes(Category::Discard));
        assert!(!off.passes(Category::Warning) && !off.passes(Category::Events) && !off.passes(Category::All));
        let events = Filter::of(true, &["logEvents"]).unwrap();
        assert!(events.passes(Category::Events) && !events.passes(Category::Warning));
        assert!(Filter::of(true, &["logAll"]).unwrap().passes(Category::Warning));
        assert!(Filter::of(true, &[]).unwrap().passes(Category::Warning));
        assert!(!Filter::of(false, &["logEvents"]).unwrap().passes(Category::Events));
        assert_eq!(Filter::of(true, &["logEvents", "logEvent"]).unwrap_err(), "logEvent");
        let all = [Category::Events, Category::Warning, Category::Discard, Category::Error, Category::Fatal];
        assert!(all.iter().zip(LOG_CATEGORIES).all(|(category, (name, _))| category.name() == name));
    }
}
