//! Notes of a case that act on nothing: cover of the report, description of an FMU.

use crate::keys::unit::NUMBER;
use crate::keys::{Range, keys};

keys! {
    /// Project that the report of `enmm report` names; nothing of this acts on the model, or on what is stored of it.
    #[derive(Eq)]
    pub default struct ReportNotes {
        /// Name of the project.
        pub project: Option<String>,
        /// Who made the analysis: name and organisation.
        pub author: Option<String>,
        /// Who ordered it.
        pub client: Option<String>,
        /// Date of the report, as it is to be printed.
        pub date: Option<String>,
        /// Number of the report or of its revision.
        pub number: Option<String>,
        /// Text below these lines.
        pub remarks: Option<String>,
    }
}

impl ReportNotes {
    /// The keys and their values.
    pub fn entries(&self) -> [(&'static str, Option<&str>); 6] {
        let Self { project, author, client, date, number, remarks } = self;
        [
            ("project", project.as_deref()),
            ("author", author.as_deref()),
            ("client", client.as_deref()),
            ("date", date.as_deref()),
            ("number", number.as_deref()),
            ("remarks", remarks.as_deref()),
        ]
    }
}

keys! {
    /// Notes for the description of an FMU: whose the case is, and blocks that have outputs of their own; nothing of
    /// this acts on the model.
    #[derive(Eq)]
    pub default struct FmuNotes {
        /// Who wrote the case: name and organisation.
        pub author: Option<String>,
        /// Notice of copyright of the case.
        pub copyright: Option<String>,
        /// Terms of use of the case.
        pub license: Option<String>,
        /// Ids of blocks whose states are outputs one by one, as `block_3.displacement_x`, for importers that have no
        /// arrays.
        #[serde(skip_serializing_if = "Vec::is_empty")]
        pub blocks: Vec<u32> => Range::from(0.0).to(1e7).of(NUMBER).hint("pictures of blocks show their ids"),
    }
}
