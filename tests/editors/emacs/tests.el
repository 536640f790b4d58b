;;; tests.el --- Rungwise through eglot in a real Emacs  -*- lexical-binding: t -*-

;; Run by emacs/run.sh in a copy of the fixtures, with the environment variable RUNGWISE_SERVER set.
;; The two modes and the entry of `eglot-server-programs' are those of docs/editors.md.

;;; Code:

(require 'package)
(package-initialize)
(require 'eglot)
(require 'flymake)
(require 'cl-lib)

(define-derived-mode rungwise-ladder-mode prog-mode "Ladder"
  (setq-local indent-tabs-mode nil truncate-lines t))
(define-derived-mode rungwise-il-mode prog-mode "PLC-IL"
  (setq-local indent-tabs-mode nil))
(add-to-list 'auto-mode-alist '("\\.lad\\'" . rungwise-ladder-mode))
(add-to-list 'auto-mode-alist '("\\.il\\'" . rungwise-il-mode))
;; One entry for each language: eglot before 1.10 sends one language for all files of a server.
(dolist (mode '((rungwise-ladder-mode . "ladder") (rungwise-il-mode . "plc-il")))
  (add-to-list 'eglot-server-programs
               `((,(car mode) :language-id ,(cdr mode)) . (,(getenv "RUNGWISE_SERVER") "lsp"))))

(defvar rungwise-tests-passed 0)
(defvar rungwise-tests-failed 0)
(defconst rungwise-tests-timeout 15 "Seconds that a state may take to come.")

(defun rungwise-tests-until (what probe)
  "Wait until PROBE gives something non-nil, and give that; WHAT is named in the error."
  (let ((end (+ (float-time) rungwise-tests-timeout)) found)
    (while (not (or (setq found (funcall probe)) (> (float-time) end)))
      (accept-process-output nil 0.02))
    (or found (error "Waited %d s for %s" rungwise-tests-timeout what))))

(defun rungwise-tests-check (name body)
  "Run BODY as the check NAME and count it."
  (let ((start (float-time)))
    (condition-case reason
        (progn
          (funcall body)
          (cl-incf rungwise-tests-passed)
          (princ (format "ok      %s (%d ms)\n" name (* 1000 (- (float-time) start)))))
      (error
       (cl-incf rungwise-tests-failed)
       (princ (format "FAILED  %s: %s\n" name (error-message-string reason)))))))

(defun rungwise-tests-open (file)
  "Visit FILE and give it a server, as `eglot' does when a user calls it."
  (find-file file)
  (unless (eglot-managed-p)
    (apply #'eglot--connect (eglot--guess-contact)))
  (rungwise-tests-until "the server" #'eglot-managed-p))

(defun rungwise-tests-errors ()
  "Lines, from 1, of the errors that flymake shows in this buffer."
  (sort (delq nil (mapcar (lambda (diagnostic)
                            (when (memq (flymake-diagnostic-type diagnostic) '(:error eglot-error))
                              (line-number-at-pos (flymake-diagnostic-beg diagnostic))))
                          (flymake-diagnostics)))
        #'<))

(defun rungwise-tests-until-errors (lines)
  "Wait for errors in exactly LINES."
  (condition-case nil
      (rungwise-tests-until (format "errors in the lines %S" lines)
                            (lambda () (equal (rungwise-tests-errors) lines)))
    (error (error "Errors in the lines %S, not %S" (rungwise-tests-errors) lines))))

(defun rungwise-tests-hover (text)
  "What eldoc is given at TEXT."
  (goto-char (point-min))
  (search-forward text)
  (goto-char (match-beginning 0))
  (let (said)
    (run-hook-with-args 'eldoc-documentation-functions
                        (lambda (string &rest _) (when string (setq said (concat said (format "%s" string))))))
    (rungwise-tests-until (format "a hover at %s" text) (lambda () said))))

(defun rungwise-tests-run ()
  "Run all checks, print their sum and leave Emacs."
  (setq eglot-sync-connect t
        eglot-autoshutdown nil
        flymake-no-changes-timeout 0.05
        eglot-send-changes-idle-time 0.01
        inhibit-message t)
  (rungwise-tests-check
   "three mistakes of a ladder are where flymake shows them"
   (lambda ()
     (rungwise-tests-open "three_mistakes.lad")
     (flymake-start)
     (rungwise-tests-until-errors '(7 13 22))))
  (rungwise-tests-check
   "drawing the missing wire takes its error away"
   (lambda ()
     (goto-char (point-min))
     (forward-line 12)
     (forward-char 16)
     (delete-char 4)
     (insert "----")
     (eglot--signal-textDocument/didChange)
     (rungwise-tests-until-errors '(7 22))
     (set-buffer-modified-p nil)))
  (rungwise-tests-check
   "the mistakes of an instruction list are shown"
   (lambda ()
     (rungwise-tests-open "mistakes_fx.il")
     (flymake-start)
     (rungwise-tests-until-errors '(3 4))))
  (rungwise-tests-check
   "eldoc explains an instruction and a device"
   (lambda ()
     (rungwise-tests-open "conveyor_fx.il")
     (unless (string-match-p "MOV" (rungwise-tests-hover "MOV"))
       (error "No MOV in the hover"))
     (unless (string-match-p "T0" (rungwise-tests-hover "T0 K50"))
       (error "No T0 in the hover"))))
  (rungwise-tests-check
   "eglot-format straightens a ladder, once and for all"
   (lambda ()
     (rungwise-tests-open "ragged.lad")
     (eglot-format-buffer)
     (let ((once (buffer-string)) (widths nil))
       (dolist (line (split-string once "\n"))
         (when (string-match-p "\\`[|+]" line)
           (cl-pushnew (string-width line) widths)))
       (unless (= (length widths) 1)
         (error "Rails in several columns: %S\n%s" widths once))
       (eglot-format-buffer)
       (unless (equal once (buffer-string))
         (error "A second run changes something")))
     (set-buffer-modified-p nil)))
  (rungwise-tests-check
   "the server ends when it is asked to"
   (lambda ()
     (let* ((server (eglot-current-server))
            (process (jsonrpc--process server)))
       (eglot-shutdown server)
       (rungwise-tests-until "the end of the server" (lambda () (not (process-live-p process)))))))
  (princ (format "%d passed, %d failed\n" rungwise-tests-passed rungwise-tests-failed))
  (kill-emacs (if (and (> rungwise-tests-passed 0) (= rungwise-tests-failed 0)) 0 1)))

(provide 'tests)
;;; tests.el ends here
