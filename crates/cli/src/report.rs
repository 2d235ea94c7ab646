//! `enmm report`: results on paper, as HTML that prints on A4 and as PDF.

use std::path::PathBuf;
use std::process::ExitCode;

use clap::Args;
use enmm_io::files::remove_if_there;
use enmm_report::paper::{Converter, PdfError, REPORT, REPORT_PDF, Records, write_report};
use enmm_run::Folder;

use crate::interrupt::{INTERRUPT, listen};
use crate::{BAD_INPUT, FAILED, Failure, INTERRUPTED, OrFail, Outcome, print_line};

/// Arguments of `enmm report`.
#[derive(Args)]
pub struct Arguments {
    /// Directory of results of enmm run, fos, bound, sample or sweep; those in its directories of these names count
    /// too.
    #[arg(value_name = "DIR")]
    directory: PathBuf,
    /// Write no PDF.
    #[arg(long, conflicts_with = "converter")]
    no_pdf: bool,
    /// Program that makes the PDF: a browser of the family of Chromium, weasyprint or wkhtmltopdf. Default: the first
    /// that is installed.
    #[arg(long, value_name = "PROGRAM")]
    converter: Option<PathBuf>,
}

/// Writes the report of a folder of results into it.
pub fn report(arguments: &Arguments) -> Outcome {
    let Arguments { directory, no_pdf, converter } = arguments;
    let records = Records::read(directory).or_fail(BAD_INPUT)?;
    let refused = |error| format!("cannot write the report ({error}): make the directory writable");
    let _held = Folder::open(directory, &[]).map_err(refused).or_fail(BAD_INPUT)?;
    let pdf = directory.join(REPORT_PDF);
    // A PDF of an earlier report would be taken for that of this one.
    let written = remove_if_there(&pdf).and_then(|()| write_report(directory, &records));
    let page = written.map_err(refused).or_fail(BAD_INPUT)?;
    print_line(&format!("{:<20} {}", "report", page.display()));
    if *no_pdf {
        return Ok(ExitCode::SUCCESS);
    }
    let Some(program) = converter.as_deref().map(Converter::named).or_else(Converter::find) else {
        print_line(&format!(
            "no PDF: no Chromium, Chrome, Edge, weasyprint or wkhtmltopdf is installed; print {REPORT} from a browser, \
             or name a program by --converter"
        ));
        return Ok(ExitCode::SUCCESS);
    };
    // A browser that is interrupted leaves neither its profile nor half a PDF.
    listen()?;
    program.convert(&page, &pdf, &INTERRUPT).map_err(|error| match error {
        PdfError::Interrupted(_) => Failure::new(error, INTERRUPTED),
        _ => Failure::new(error, FAILED),
    })?;
    print_line(&format!("{:<20} {}", "PDF", pdf.display()));
    Ok(ExitCode::SUCCESS)
}
